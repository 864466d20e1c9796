// T_RISE, as the bench breq-rotary measures it.
#pragma once

#include "testbench/benches/breq_host.h"

namespace brick {

// Full buffers of random length run empty, at several points and with short and long lines; leaves them empty.
void measure_rise_times(BenchContext& b, BreqHost& host);

}  // namespace brick
