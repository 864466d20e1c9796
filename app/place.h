// HOST:PORT as options have it.
#pragma once

#include <string>

namespace brick {

struct Place {
  std::string host, port;  // an IPv6 address without its brackets, of * the one that means all; up to five digits
};

// Throws UsageError, with `example` in it.
Place parse_place(const std::string& option, const std::string& text, const std::string& example);

}  // namespace brick
