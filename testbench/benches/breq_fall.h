// How long a line takes from its CR to BREQ (T_FALL, host-bus:5.7), while a coordinate system runs such lines.
#pragma once

#include "testbench/benches/breq_host.h"

namespace brick {

// Lines of one to eight axes with constants, under three loads, such with expressions and such of 255 characters: each
// line's time less the tasks that interrupted, and the own times of those tasks.
void measure_fall_times(BenchContext& b, BreqHost& host);

}  // namespace brick
