// `brick list`: the testbenches.
#include <iostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands.h"

namespace brick {

int list_command(const std::vector<Bench>& benches, bool json) {
  nlohmann::json list = nlohmann::json::array();
  for (const Bench& bench : benches) {
    nlohmann::json also = nlohmann::json::array();
    for (const NegativeControl::Also& a : bench.negative.also) also.push_back({{"step", a.step}, {"says", a.says}});
    if (json)
      list.push_back({{"name", bench.name},
                      {"description", bench.description},
                      {"negative", bench.negative.does},
                      {"negative_step", bench.negative.step},
                      {"negative_says", bench.negative.says},
                      {"negative_also", also},
                      {"needs", bench.need.what},
                      {"board", bench.board}});
    else
      std::cout << fmt::format("{:<14} {}\n", bench.name, bench.description);
  }
  if (json) std::cout << list.dump(2) << '\n';
  return 0;
}

}  // namespace brick
