// What `brick regress` makes: rows of a plan in TOML, each benches x engines x boards x seeds and more, or any command
// (docs/regress.md). All of a plan is checked before anything runs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/bench.h"

namespace brick::regress {

struct Run {
  std::string name;                // of its folder: smoke.systemc.geobrick-lv-8.seed-1
  std::string group;               // the bench, or the name of the command
  std::string column;              // where it stands in the table of results: engine, board, what else was chosen
  std::string engine;              // "" of a command
  std::string choice;              // all but the engine: equal in runs whose verdicts should be
  std::uint64_t seed = 0;          //
  std::vector<std::string> words;  // program and arguments; those of `brick` are without --json
  double limit_seconds = 0;        // of the wall
  bool alone = false;              // no other run of the plan beside it
  bool bench() const { return !engine.empty(); }
};

struct Plan {
  std::string title;
  std::vector<Run> runs;
};

// `fresh_from`: where seeds that a row asks for by `fresh` come from. Throws UsageError.
Plan read_plan(const std::string& path, const std::vector<Bench>& benches, std::uint64_t fresh_from);

}  // namespace brick::regress
