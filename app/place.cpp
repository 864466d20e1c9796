#include "app/place.h"

#include <cstdint>

#include <fmt/format.h>

#include "systemc/core/usage_error.h"

namespace brick {

Place parse_place(const std::string& option, const std::string& text, const std::string& example) {
  const std::size_t colon = text.rfind(':');
  Place place{text.substr(0, colon), colon == std::string::npos ? "" : text.substr(colon + 1)};
  std::string& host = place.host;
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  const bool digits =
      !place.port.empty() && place.port.size() <= 5 && place.port.find_first_not_of("0123456789") == std::string::npos;
  if (host.empty() || !digits || std::stoul(place.port) > UINT16_MAX)
    throw UsageError(fmt::format("{} {}: is no place; expected HOST:PORT, for example {}", option, text, example));
  return place;
}

}  // namespace brick
