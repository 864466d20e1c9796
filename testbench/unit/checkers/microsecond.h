// A microsecond in the units of the checkers.
#pragma once

#include "systemc/core/ticks.h"

namespace brick {

constexpr Tick kUs = ns_to_ticks(1000);
constexpr TimeFs kUsInFs = 1000 * kFsPerNs;

}  // namespace brick
