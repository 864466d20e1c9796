// How long a line takes from its CR to BREQ (T_FALL, host-bus:5.7), while a coordinate system runs such lines.
#pragma once

#include "testbench/benches/breq_host.h"

namespace brick {

// Lines of one to eight axes with constants, such with expressions and such of 255 characters, under two loads that are
// judged: each line's time less the tasks that interrupted. Under a third, 32 commutated motors, the times are reported
// only. Of all three the own times of those tasks are judged. Motors are left as they came.
void measure_fall_times(BenchContext& b, BreqHost& host);

}  // namespace brick
