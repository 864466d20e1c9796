// Words of an IC and of the board as its tests name them: those of channel 1, the next channels are 8 further.
#pragma once

#include <cstdint>

namespace brick {

constexpr std::uint32_t kChannelControl = 5, kOutA = 2, kOutC = 4;  // X, Y, Y
constexpr std::uint32_t kNoSource = 31;                             // of PHASE, servo-ic:7.2/5

}  // namespace brick
