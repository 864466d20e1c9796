#include "testbench/benchmark/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <ctime>

namespace brick {

double seconds(const std::function<void()>& work) {
  const std::clock_t begin = std::clock();
  work();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

void row(const std::string& what, const std::string& measured, const std::string& goal, bool met) {
  fmt::print("{:<58} {:>22}   {:<22} {}\n", what, measured, goal, goal.empty() ? "" : met ? "met" : "MISSED");
  std::fflush(stdout);
}

}  // namespace brick
