// One line of a vector file, cut into words and taken apart from left to right. Every mistake becomes a VectorError
// that says what was found and what was expected.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "testbench/unit/vectors/vector.h"

namespace brick {

class Statement {
 public:
  // `where`: "file:line", first part of error messages. '#' begins a comment.
  Statement(std::string where, std::string_view text, const Vector& vector, const std::vector<std::string>& marks);

  bool empty() const { return words_.empty(); }
  bool at_end() const { return next_ == words_.size(); }
  bool take(std::string_view word);  // if it is the next one
  void expect(std::string_view word);
  void end();
  std::string name(const char* what);
  std::string quoted(const char* what);

  unsigned signal();
  unsigned input();
  Edge edge();
  SignalEdge signal_edge();
  Word word();             // X:$05
  std::uint32_t bits24();  // an expression, two's complement in 24 bits
  std::int64_t number();   // $hex, decimal, with << | + - and unary minus
  Tick duration();         // number, then a unit or `ticks`
  TimePoint time();        // a mark, + or - a duration
  Window window();         // from TIME to TIME
  std::string bits();      // 0s and 1s, _ between

  [[noreturn]] void fail(const std::string& expected) const;  // at the next word

 private:
  std::int64_t term();
  std::string peek() const { return at_end() ? "" : words_[next_]; }

  std::string where_;
  const Vector& vector_;
  const std::vector<std::string>& marks_;
  std::vector<std::string> words_;
  std::size_t next_ = 0;
};

// A step, or nothing for an empty line.
std::optional<Step> parse_step(const std::string& where, int line, std::string_view text, const Vector& vector,
                               std::vector<std::string>& marks);

}  // namespace brick
