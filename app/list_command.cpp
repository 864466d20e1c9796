// `brick list` and `brick boards`: what there is.
#include <iostream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/paths.h"
#include "systemc/machine/board_file.h"
#include "testbench/benches/bench.h"

namespace brick {

int list_command(bool json) {
  nlohmann::json list = nlohmann::json::array();
  for (const Bench& bench : all_benches()) {
    if (json)
      list.push_back({{"name", bench.name}, {"description", bench.description}, {"negative", bench.negative}});
    else
      std::cout << fmt::format("{:<14} {}\n", bench.name, bench.description);
  }
  if (json) std::cout << list.dump(2) << '\n';
  return 0;
}

int boards_command(bool json) {
  nlohmann::json list = nlohmann::json::array();
  for (const std::string& name : board_names()) {
    const BoardConfig board = read_board_file(board_path(name));
    const auto ics = fitted_ic_names(board.fitted);
    if (json)
      list.push_back(
          {{"name", board.name}, {"title", board.title}, {"ics", ics}, {"dpram_words", board.dpram_words}, {"card", board.card}});
    else
      std::cout << fmt::format("{:<21} {}\n{:<21} {}; dual-ported RAM {} k x 16; card {}\n", board.name, board.title, "",
                               fmt::join(ics, ", "), board.dpram_words / 1024, board.card);
  }
  if (json) std::cout << list.dump(2) << '\n';
  return 0;
}

}  // namespace brick
