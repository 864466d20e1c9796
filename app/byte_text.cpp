#include "app/byte_text.h"

#include <fmt/format.h>

namespace brick {

std::string visible_bytes(std::string_view bytes) {
  std::string text;
  for (const unsigned char c : bytes)
    if (c < ' ' || c >= 0x7F)
      text += fmt::format("<{:02X}>", c);
    else
      text.push_back(static_cast<char>(c));
  return text;
}

std::string beginning_of(std::string_view bytes) {
  constexpr std::size_t kShown = 60;
  if (bytes.size() <= kShown) return "`" + visible_bytes(bytes) + "`";
  return fmt::format("`{}`... ({} bytes)", visible_bytes(bytes.substr(0, kShown)), bytes.size());
}

}  // namespace brick
