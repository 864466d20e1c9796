// Fixed delays of the clock chain that whoever compares its pins must know, in ticks (servo-ic:5.1/11,
// servo-ic:5.11/10).
#pragma once

#include "systemc/core/ticks.h"

namespace brick {

constexpr Tick kNetDelay = 2;  // PHASE and SERVO reach the nets through two flip-flops: after the IC that drives them
constexpr Tick kPinDelay = 3;  // two flip-flops: an IC acts on an edge of PHASE or SERVO at the third tick
constexpr Tick kPwmDelay = 2;  // the triangle reaches a channel through a flip-flop, the switches follow the comparison

}  // namespace brick
