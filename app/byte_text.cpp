#include "app/byte_text.h"

#include <array>
#include <cstdint>

#include <fmt/format.h>

namespace brick {

namespace {

struct Character {
  std::size_t bytes;   // 1 where there is none
  std::uint32_t code;  // kNone: no UTF-8
};
constexpr std::uint32_t kNone = ~0u, kHighest = 0x10FFFF, kSpace = 0x20, kDelete = 0x7F, kControlsEnd = 0xA0;

// By the table of well-formed sequences: no form longer than needed, no half of a pair, nothing above U+10FFFF.
Character character_at(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t n) -> std::uint32_t { return static_cast<unsigned char>(text[at + n]); };
  if (byte(0) < 0x80) return {1, byte(0)};
  static constexpr std::array<std::uint32_t, 5> kFirstOfLength{0, 0, 0x80, 0x800, 0x10000};
  const std::size_t bytes = byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : 2;
  if (byte(0) < 0xC0 || byte(0) >= 0xF8 || text.size() - at < bytes) return {1, kNone};
  std::uint32_t code = byte(0) & (0x7Fu >> bytes);
  for (std::size_t n = 1; n < bytes; ++n) {
    if ((byte(n) & 0xC0) != 0x80) return {1, kNone};
    code = code << 6 | (byte(n) & 0x3F);
  }
  const bool half_of_a_pair = code >= 0xD800 && code < 0xE000;
  if (code < kFirstOfLength[bytes] || code > kHighest || half_of_a_pair) return {1, kNone};
  return {bytes, code};
}

template <typename Shown>
std::string with_numbers(std::string_view bytes, Shown shown) {
  std::string text;
  for (std::size_t at = 0; at < bytes.size();) {
    const Character c = character_at(bytes, at);
    if (shown(c.code))
      text += bytes.substr(at, c.bytes);
    else
      for (std::size_t n = 0; n < c.bytes; ++n) text += fmt::format("<{:02X}>", bytes[at + n] & 0xFF);
    at += c.bytes;
  }
  return text;
}

bool is_control(std::uint32_t code) { return code < kSpace || (code >= kDelete && code < kControlsEnd); }

}  // namespace

std::string visible_bytes(std::string_view bytes) {
  return with_numbers(bytes, [](std::uint32_t code) { return code >= kSpace && code < kDelete; });
}

std::string utf8_text(std::string_view bytes) {
  return with_numbers(bytes, [](std::uint32_t code) { return code != kNone; });
}

std::string readable_text(std::string_view bytes) {
  return with_numbers(bytes, [](std::uint32_t code) { return code != kNone && !is_control(code); });
}

std::string cut_text(std::string_view bytes, std::size_t most) {
  return bytes.size() <= most ? readable_text(bytes) : readable_text(bytes.substr(0, most)) + "...";
}

std::string beginning_of(std::string_view bytes, std::size_t most) {
  if (bytes.size() <= most) return "`" + readable_text(bytes) + "`";
  return fmt::format("`{}`... ({} bytes)", readable_text(bytes.substr(0, most)), bytes.size());
}

}  // namespace brick
