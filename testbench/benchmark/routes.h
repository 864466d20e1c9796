// How fast program lines reach a rotary buffer, in simulated time: by the host port, by the ASCII buffer of the
// dual-ported RAM, as binary lines with I45 = 0 and 1. The SystemC engine; the same numbers at each run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "systemc/core/ticks.h"
#include "systemc/machine/machine.h"

namespace brick {

enum class Route { kHostPort, kRamAscii, kBinary0, kBinary1 };
constexpr Route kRoutes[] = {Route::kHostPort, Route::kRamAscii, Route::kBinary0, Route::kBinary1};
const char* route_name(Route route);

std::string route_line(unsigned axes, unsigned number);  // of 1 to 9 axes, five digits each

// A large ring, no program runs; lines as fast as the host can give them.
struct RouteSpeed {
  double lines_per_second;
  double lines_one_by_one;          // each waited for, until it is in the ring
  double io_cycles, memory_cycles;  // of the host's bus, a line
  double bus_us;                    // that these take
  double cpu_cycles;                // that the CPU works for a line, tasks of an idle controller taken away
};
double measure_lines_per_second(Route route, unsigned axes, unsigned lines, Engine engine, const std::string& firmware);
RouteSpeed measure_route(Route route, unsigned axes, unsigned lines, Engine engine, const std::string& firmware);

// From the end of the host's last write of a line of two axes to the fall of BREQ, single lines at any time; sorted.
std::vector<double> measure_breq_us(Route route, unsigned lines, bool plcs, const std::string& firmware);

}  // namespace brick
