// How long a line takes from its CR to BREQ (T_FALL, host-bus:5.7), while a coordinate system runs such lines.
#pragma once

#include "testbench/benches/breq_host.h"

namespace brick {

// Lines of one to eight axes with constants, under two loads: judged by the longest and the median time of all. Lines
// with expressions, and such of 255 characters, are measured and not judged.
void measure_fall_times(BenchContext& b, BreqHost& host);

}  // namespace brick
