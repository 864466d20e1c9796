#include "testbench/checkers/task_times.h"

#include <algorithm>

namespace brick {

void TaskTimes::changed(TimeFs time, unsigned task) {
  const Change last = changes_.back();
  if (!in_handler_) own_[last.task] += time - last.time;
  in_handler_ = task == last.task && !in_handler_;
  if (task > last.task) own_[task] = 0;  // a run begins: only higher tasks interrupt
  if (task < last.task) {
    Runs& runs = runs_[last.task];
    ++runs.count;
    runs.longest = std::max(runs.longest, own_[last.task]);
  }
  changes_.push_back({time, task});
}

TimeFs TaskTimes::above_background(TimeFs from, TimeFs to) const {
  TimeFs sum = 0;
  for (std::size_t i = 0; i < changes_.size(); ++i) {
    if (changes_[i].task == kBackground) continue;
    const TimeFs end = i + 1 < changes_.size() ? changes_[i + 1].time : to;
    sum += std::max<TimeFs>(0, std::min(end, to) - std::max(changes_[i].time, from));
  }
  return sum;
}

void TaskTimes::forget_changes() { changes_.erase(changes_.begin(), changes_.end() - 1); }

}  // namespace brick
