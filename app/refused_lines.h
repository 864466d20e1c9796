// The lines that the controller refused: what is told of each, and of all together at the end.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

namespace brick {

// What ERRnnn says (firmware:6.4).
std::string_view error_meaning(std::string_view error);

class RefusedLines {
 public:
  static constexpr std::size_t kTold = 50;  // one by one; the rest is counted

  // What is to be told: "" when enough has been.
  std::string add(const std::string& place, const std::string& line, const std::string& error);
  std::size_t count() const { return count_; }
  std::string summary(std::size_t lines) const;  // "" when none was refused

 private:
  std::size_t count_ = 0;
  std::map<std::string, std::size_t> by_error_;
};

}  // namespace brick
