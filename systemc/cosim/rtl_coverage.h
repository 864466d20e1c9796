// Coverage counters of a Verilated model. In a build with coverage (./dev coverage) each model of each process leaves
// files of its own in the folder that BRICK_RTL_COVERAGE names; tools/coverage.py merges them. Otherwise nothing.
#pragma once

#include <verilated.h>
#ifdef BRICK_RTL_COVERAGE
#include <unistd.h>
#include <verilated_cov.h>

#include <cstdlib>
#include <string>
#endif

namespace brick {

inline void write_coverage([[maybe_unused]] VerilatedContext& context, [[maybe_unused]] const char* end = ".dat") {
#ifdef BRICK_RTL_COVERAGE
  static int written = 0;
  const char* folder = std::getenv("BRICK_RTL_COVERAGE");
  if (folder == nullptr) return;
  const std::string name = std::to_string(getpid()) + "_" + std::to_string(++written);
  context.coveragep()->forcePerInstance(true);  // a bit that rose in one and fell in another did not do both
  context.coveragep()->write((folder + ("/" + name) + end).c_str());
#endif
}

// In reset: up to there a bit may have changed from its random start value alone; one that changes from here on has
// changed. The lines so far go to a file of their own, for the counter of an always_comb block counts then only; its
// bits are not looked at.
inline void start_coverage([[maybe_unused]] VerilatedContext& context) {
#ifdef BRICK_RTL_COVERAGE
  write_coverage(context, "_start.dat");
  context.coveragep()->zero();
#endif
}

}  // namespace brick
