// Runs a vector on a device and checks what it expects.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "testbench/unit/vectors/record.h"

namespace brick {

struct RunResult {
  std::vector<std::string> failures;  // file:line: statement: found ...
  unsigned checks = 0;
  std::map<std::string, Tick> marks;  // and `begin`, after the first reset
  Record record;
  std::vector<std::string> bus;  // bus cycles, as values 1, 2 ... of the signal `bus`

  bool passed() const { return failures.empty() && checks > 0; }
  std::string text() const;  // the failures, one a line
  Tick at(const TimePoint& t) const { return marks.at(t.mark) + t.offset; }
};

// `corruption`: a planted fault, not owned.
RunResult run_vector(const Vector& vector, Device& device, const Corruption* corruption = nullptr);

}  // namespace brick
