// Hosts that keep no rule of the bus: a strobe that is too short, two commands at once, an address that moves, a full
// TX written, resets and a power loss in the middle of a cycle. Each must be named by its rule alone and leave the
// machine working.
#pragma once

#include "app/bench.h"

namespace brick {

void malformed_hosts(BenchContext& b);  // forgets what the checker of the host bus has found before

}  // namespace brick
