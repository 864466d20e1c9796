// Tasks as job arrays of a Slurm cluster. What they have made stands in files; the cluster is asked only whether
// anything of an array still waits or runs.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "app/regress/task.h"

namespace brick::regress {

class Cluster {
 public:
  // `folder`: of the results, seen by all machines. `at_once`: tasks; 0 = as many as the cluster gives.
  Cluster(std::string folder, unsigned at_once) : folder_(std::move(folder)), at_once_(at_once) {}
  ~Cluster() { cancel(); }
  Cluster(const Cluster&) = delete;
  Cluster& operator=(const Cluster&) = delete;

  static constexpr std::size_t kMostTasks = 1000;  // of an array, as Slurm has it without a setting

  // `longest`: seconds a task may take in all. Throws UsageError with what the cluster says when it takes none.
  void submit(const std::vector<Task>& tasks, double longest);
  bool working();        // also while the cluster does not answer for less than some minutes
  bool answers() const;  // or has done so lately
  // And waits for the end of what runs. Where it may go on this is said, and the next call on the folder tries again.
  void cancel();

  // What a call that was killed has left at work in `folder`. Throws UsageError when it may go on.
  static void cancel_left_over(const std::string& folder);

 private:
  const std::string folder_;
  const unsigned at_once_;
  std::string job_;
  std::chrono::steady_clock::time_point heard_ = std::chrono::steady_clock::now();
  unsigned arrays_ = 0;
};

}  // namespace brick::regress
