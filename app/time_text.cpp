#include "app/time_text.h"

#include <cctype>

#include "app/byte_text.h"
#include "systemc/core/usage_error.h"

namespace brick {

TimeFs parse_time(const std::string& text) {
  const auto bad = [&] {
    return UsageError(beginning_of(text) + " is no time; expected a number with ns, us, ms or s, for example 10ms");
  };
  constexpr TimeFs kLongest = 1'000'000'000 * TimeFs{1'000'000'000'000'000};  // 31 years
  std::size_t at = 0;
  __int128 digits = 0;
  unsigned decimals = 0, count = 0;
  bool fraction = false;
  for (; at < text.size() && (std::isdigit(static_cast<unsigned char>(text[at])) || (text[at] == '.' && !fraction));
       ++at) {
    if (text[at] == '.') {
      fraction = true;
      continue;
    }
    digits = digits * 10 + (text[at] - '0');
    if (fraction) ++decimals;
    if (++count > 18) throw bad();
  }
  const std::string unit = text.substr(at);
  __int128 femtoseconds = unit == "ns"   ? 1'000'000
                          : unit == "us" ? 1'000'000'000
                          : unit == "ms" ? 1'000'000'000'000
                                         : 0;
  if (unit == "s") femtoseconds = 1'000'000'000'000'000;
  if (count == 0 || femtoseconds == 0) throw bad();
  __int128 value = digits * femtoseconds;
  for (; decimals > 0; --decimals) value /= 10;
  if (value > kLongest) throw UsageError(beginning_of(text) + " is too long a time; expected at most 1000000000s");
  return value;
}

}  // namespace brick
