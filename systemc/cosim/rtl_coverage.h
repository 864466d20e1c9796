// Coverage counters of a Verilated model. In a build with coverage (./dev coverage) each model of each process leaves a
// file of its own in the folder that BRICK_RTL_COVERAGE names; tools/coverage.py merges them. Otherwise nothing.
#pragma once

#include <verilated.h>
#ifdef BRICK_RTL_COVERAGE
#include <unistd.h>
#include <verilated_cov.h>

#include <cstdlib>
#include <string>
#endif

namespace brick {

inline void write_coverage([[maybe_unused]] VerilatedContext& context) {
#ifdef BRICK_RTL_COVERAGE
  static int written = 0;
  const char* folder = std::getenv("BRICK_RTL_COVERAGE");
  if (folder == nullptr) return;
  const std::string name = std::to_string(getpid()) + "_" + std::to_string(++written);
  context.coveragep()->write((folder + ("/" + name) + ".dat").c_str());
#endif
}

}  // namespace brick
