// What T_FALL and the tasks beside it may take (host-bus:5.7/5), apart from the bench that measures them: so each limit
// is tried one femtosecond, one cycle and one line beyond it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "systemc/core/ticks.h"

namespace brick {

struct Fall {
  TimeFs whole, net, most;  // of a line: with the tasks above the background, without them, and what that may be
};

struct FallLimits {
  static constexpr TimeFs kMicrosecond = 1000 * kFsPerNs;
  static constexpr TimeFs kWorst = 50 * kMicrosecond, kMedian = 24 * kMicrosecond;  // lines of axes with constants
  static constexpr TimeFs kCharacter = 6 * kMicrosecond;                            // other lines, beside kWorst
  static constexpr std::uint64_t kPhaseCycles = 4'400, kServoCycles = 8'000;

  static constexpr TimeFs of_line(bool axes_with_constants, std::size_t characters) {
    return kWorst + (axes_with_constants ? 0 : static_cast<TimeFs>(characters) * kCharacter);
  }

  // The nearest to its limit, or beyond it; there is one at least.
  static const Fall& worst(const std::vector<Fall>& falls) {
    return *std::max_element(falls.begin(), falls.end(),
                             [](const Fall& a, const Fall& b) { return a.net - a.most < b.net - b.most; });
  }
  static TimeFs median(const std::vector<Fall>& falls) {
    std::vector<TimeFs> net;
    for (const Fall& f : falls) net.push_back(f.net);
    std::sort(net.begin(), net.end());
    return net[net.size() / 2];
  }

  // As many as were sent, each within its own.
  static bool keeps(const std::vector<Fall>& falls, std::size_t sent) {
    return falls.size() == sent && sent > 0 && worst(falls).net <= worst(falls).most;
  }
  static bool keeps_median(const std::vector<Fall>& falls) { return !falls.empty() && median(falls) <= kMedian; }
  // A task that never ran has kept nothing.
  static constexpr bool keeps_cycles(std::uint64_t runs, std::uint64_t longest, std::uint64_t most) {
    return runs > 0 && longest <= most;
  }
};

}  // namespace brick
