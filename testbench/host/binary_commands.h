// Program text to the commands of a binary rotary buffer (host-bus:7.7), as the host's library makes them. What that
// form cannot express is refused by the library's codes: constants of more than 23 bits or beyond 2^31, hexadecimal
// ones, expressions, conditions and texts go the way of ASCII.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace brick {

// host-bus:7.5, row PCOMM.
enum class BinaryResult {
  kError = -1,  // no buffer of this size, or the controller has stopped the transfer
  kOk = 0,
  kBusy = 1,
  kEndOfFile = 2,
  kAllocation = -59,
  kFloat = -60,       // needs more than 23 bits
  kConversion = -61,  // no number where there has to be one
  kIllegal = -62,     // a statement, or an argument, without binary form
  kRange = -63,
  kSyntax = -70
};

struct BinaryCommand {
  std::uint32_t first, second;  // 24 bits each
};

struct BinaryLine {
  BinaryResult result = BinaryResult::kOk;
  std::vector<BinaryCommand> commands;  // none for a blank line or a comment, as with ASCII
};

BinaryLine binary_line(std::string_view text);

}  // namespace brick
