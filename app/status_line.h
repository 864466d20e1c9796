// The last row of a terminal, kept apart from the rows above it, in which all else scrolls.
#pragma once

#include <string>

namespace brick {

class StatusLine {
 public:
  StatusLine();   // where stdout is no terminal, or one of no moving cursor, nothing is shown
  ~StatusLine();  // the terminal has all of its rows again
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  bool shown() const { return shown_; }
  void show(const std::string& text);  // cut where the row ends

 private:
  void reserve();

  bool shown_ = false;
  unsigned rows_ = 0, columns_ = 0;
};

}  // namespace brick
