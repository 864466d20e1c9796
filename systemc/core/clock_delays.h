// Fixed delays of the clock chain that whoever compares its pins must know, in ticks (servo-ic:5.1/11,
// servo-ic:5.11/10).
#pragma once

#include "systemc/core/ticks.h"

namespace brick {

constexpr Tick kNetDelay = 1;  // PHASE and SERVO leave the board through flip-flops: after the IC that drives them
constexpr Tick kPinDelay = 3;  // two flip-flops: an IC acts on an edge of PHASE or SERVO at the third tick
constexpr Tick kPwmDelay = 1;  // the switches follow the comparison with the triangle

}  // namespace brick
