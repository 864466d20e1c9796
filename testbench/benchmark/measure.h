// Stop-watch and table of the benchmark. Time is processor time of this process: on a quiet machine that is wall time,
// and on any other the neighbours do not count.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace brick {

constexpr int kRounds = 5;
constexpr double kTicksPerSecond = 117'964'800;

double seconds(const std::function<void()>& work);
double median(std::vector<double> v);

// A row of the table; without a goal nothing is judged.
void row(const std::string& what, const std::string& measured, const std::string& goal = "", bool met = true);

}  // namespace brick
