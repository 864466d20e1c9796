// Prints the measures of all routes as lines of JSON, for tools/draw_routes.py. `brick_routes FIRMWARE.elf`
#include <cstdio>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "testbench/benchmark/routes.h"

namespace brick {
namespace {

constexpr unsigned kLines = 400, kSingleLines = 60;

nlohmann::json delays(Route route, bool plcs, const std::string& firmware) {
  const std::vector<double> us = measure_breq_us(route, kSingleLines, plcs, firmware);
  return {{"least", us.front()}, {"median", us[us.size() / 2]}, {"most", us.back()}};
}

int run(const std::string& firmware) {
  for (const Route route : kRoutes) {
    for (const unsigned axes : {1u, 2u, 4u, 8u}) {
      const RouteSpeed s = measure_route(route, axes, kLines, Engine::kSystemC, firmware);
      const nlohmann::json row = {{"route", route_name(route)},
                                  {"axes", axes},
                                  {"lines_per_second", s.lines_per_second},
                                  {"one_by_one", s.lines_one_by_one},
                                  {"io_cycles", s.io_cycles},
                                  {"memory_cycles", s.memory_cycles},
                                  {"bus_us", s.bus_us},
                                  {"cpu_cycles", s.cpu_cycles}};
      std::printf("%s\n", row.dump().c_str());
    }
    const nlohmann::json row = {{"route", route_name(route)},
                                {"breq", delays(route, false, firmware)},
                                {"breq_with_plcs", delays(route, true, firmware)}};
    std::printf("%s\n", row.dump().c_str());
  }
  return 0;
}

}  // namespace
}  // namespace brick

int sc_main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: brick_routes FIRMWARE.elf\n");
    return 2;
  }
  try {
    return brick::run(argv[1]);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "brick_routes: %s\n", e.what());
    return 1;
  }
}
