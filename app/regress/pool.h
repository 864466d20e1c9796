// Programs that run at the same time, each in a folder of its own and in a group of processes of its own, and none of
// them longer than its limit. A watcher stands between each and us: when we are gone, whatever killed us, it kills the
// group.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace brick::regress {

struct Ended {
  enum class How { kExit, kSignal, kLimit };
  std::size_t id = 0;
  How how = How::kSignal;
  int code = 0;  // exit status, or number of the signal
  double seconds = 0;
};

class Pool {
 public:
  explicit Pool(unsigned jobs);  // throws UsageError when the system has no pipes left
  ~Pool();                       // ends all that runs
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  bool full() const { return running_.size() >= jobs_; }
  bool empty() const { return running_.empty(); }
  std::size_t size() const { return running_.size(); }

  // `words`: program and arguments; the program of a name without a slash is looked for in PATH. What it prints goes to
  // `folder`/output.txt. `limit`: seconds. Throws UsageError when the system gives no process.
  void start(std::size_t id, const std::vector<std::string>& words, const std::string& folder, double limit);

  // One that has ended, or nothing within the time.
  std::optional<Ended> wait(std::chrono::milliseconds patience);

 private:
  struct Running {
    std::size_t id;
    pid_t watcher;
    int told;  // where the watcher says how it ended
    std::chrono::steady_clock::time_point begin;
  };

  const std::size_t jobs_;
  int alive_[2] = {-1, -1};  // nobody writes: it ends with us
  std::vector<Running> running_;
};

}  // namespace brick::regress
