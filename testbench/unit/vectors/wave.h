// Draws the part of a run that a vector's [wave] selects, as WaveDrom source.
#pragma once

#include <string>

#include "testbench/unit/vectors/runner.h"

namespace brick {

// Throws UsageError when the drawing would hide something: a step that swallows an edge, an arrow without its edges.
std::string wavedrom(const Vector& vector, const RunResult& run);

}  // namespace brick
