// What a step of a bench compared: how often, and the first difference in words (where, measured, expected). Each step
// states how many comparisons it takes for its verdict to mean something (BenchReport::step).
#pragma once

#include <cstdint>
#include <string>

#include <fmt/format.h>

namespace brick {

inline std::string printed(const std::string& value) { return value; }
inline std::string printed(std::int64_t value) { return std::to_string(value); }

class Comparison {
 public:
  // `where`: channel, word or bit.
  bool equal(const std::string& where, std::int64_t measured, std::int64_t expected) {
    return note(where, measured == expected, printed(measured), printed(expected));
  }
  bool equal(const std::string& where, const std::string& measured, const std::string& expected) {
    return note(where, measured == expected, measured, expected);
  }
  bool word(const std::string& where, std::int64_t measured, std::int64_t expected) {  // low 24 bits
    const std::int64_t m = measured & 0xFFFFFF, e = expected & 0xFFFFFF;
    return note(where, m == e, fmt::format("${:06X}", m), fmt::format("${:06X}", e));
  }
  bool within(const std::string& where, std::int64_t measured, std::int64_t from, std::int64_t to) {
    return note(where, measured >= from && measured <= to, printed(measured), fmt::format("{} to {}", from, to));
  }
  // Something that another judge has compared; `difference` is empty or says what is wrong.
  bool judged(const std::string& where, const std::string& difference, unsigned count = 1) {
    made_ += count;
    if (!difference.empty() && difference_.empty()) difference_ = where + ": " + difference;
    return difference.empty();
  }

  unsigned made() const { return made_; }
  const std::string& difference() const { return difference_; }  // the first, "" if there is none

 private:
  bool note(const std::string& where, bool same, const std::string& measured, const std::string& expected) {
    return judged(where, same ? "" : measured + ", expected " + expected);
  }

  unsigned made_ = 0;
  std::string difference_;
};

}  // namespace brick
