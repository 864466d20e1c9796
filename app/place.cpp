#include "app/place.h"

#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>

#include <fmt/format.h>

#include "systemc/core/usage_error.h"

namespace brick {

namespace {
// Of IPv6, which listens at those of IPv4, too; of IPv4 where the system has no other.
std::string every_address() {
  const int probe = socket(AF_INET6, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (probe < 0) return "0.0.0.0";
  close(probe);
  return "::";
}
}  // namespace

Place parse_place(const std::string& option, const std::string& text, const std::string& example) {
  const std::size_t colon = text.rfind(':');
  Place place{text.substr(0, colon), colon == std::string::npos ? "" : text.substr(colon + 1)};
  std::string& host = place.host;
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  const bool digits =
      !place.port.empty() && place.port.size() <= 5 && place.port.find_first_not_of("0123456789") == std::string::npos;
  if (host.empty() || !digits || std::stoul(place.port) > UINT16_MAX)
    throw UsageError(fmt::format("{} {}: is no place; expected HOST:PORT, for example {}", option, text, example));
  if (host == "*") host = every_address();
  return place;
}

}  // namespace brick
