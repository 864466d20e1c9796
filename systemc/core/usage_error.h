// Bad usage or bad input (command line, host script, board file, timing vector): one line that says what, where and
// what was expected. `brick` prints it and ends with status 2.
#pragma once

#include <stdexcept>

namespace brick {

class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace brick
