// One run in its folder, and runs in a row within a time: what a task of a cluster makes (docs/regress.md).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/regress/plan.h"
#include "app/regress/pool.h"

namespace brick::regress {

std::string this_executable();

// Begins the run in a fresh `folder`. Throws UsageError without room for results.
void begin(Pool& pool, std::size_t id, const Run& run, const std::string& folder);

struct Task {
  struct Part {  // NOLINT(bugprone-exception-escape): a move of JSON throws for broken JSON only
    Run run;
    std::string folder;
    nlohmann::json build;  // app/build_info.h, with the image of the run
  };
  std::vector<Part> parts;
  double seconds = 0;      // begins nothing after so much of the wall
  std::int64_t until = 0;  // nor after this second of the clock
};

// As a file for the one that makes it. Throw UsageError.
void write_task(const Task& task, const std::string& file);
// Makes the runs that have no result yet, one after the other, and leaves their results in their folders.
int task_command(const std::string& file);

}  // namespace brick::regress
