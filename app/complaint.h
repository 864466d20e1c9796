// What goes wrong again and again is said the 1st, 10th, 100th ... time: whoever reads that may be slow, or nobody, and
// a pipe that is full would hold the simulation up.
#pragma once

#include <cstddef>
#include <string>

#include <fmt/format.h>

namespace brick {

class Complaint {
 public:
  // "" when it is not to be said this time.
  std::string text(const std::string& what) {
    if (++count_ < next_) return "";
    next_ *= kTimes;
    return count_ == 1 ? what : fmt::format("{} ({} times so far)", what, count_);
  }

 private:
  static constexpr std::size_t kTimes = 10;
  std::size_t count_ = 0, next_ = 1;
};

}  // namespace brick
