// `brick run --cover`: which lines of the firmware the image has executed, as lcov's tracefile (docs/covers.md).
#pragma once

#include <string>

#include "app/run_bench.h"

namespace brick {

// What it adds to a run; nothing for "". Throws UsageError when it cannot be written.
RunExtras line_cover(const std::string& file, const RunOptions& options);

}  // namespace brick
