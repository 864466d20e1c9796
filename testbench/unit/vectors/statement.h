// One line of a vector file taken apart: the host script's reader of lines, and the words that vectors have beside it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/line_reader.h"
#include "testbench/unit/vectors/vector.h"

namespace brick {

class Statement : public LineReader {
 public:
  // `marks`: those set on the lines before.
  Statement(std::string_view text, const Vector& vector, const std::vector<std::string>& marks)
      : LineReader(text, '#'), vector_(vector), marks_(marks) {}

  unsigned signal();
  unsigned input();
  std::optional<Edge> edge();  // if one comes next
  SignalEdge signal_edge();
  Word register_word();       // X:$05
  std::int64_t expression();  // numbers with << | + -
  std::uint32_t bits24();     // an expression, two's complement in 24 bits
  Tick duration();            // a time as in host scripts, or a number with a unit of the vector; alone: ticks
  TimePoint time_point();     // a mark, + or - durations
  Window window();            // from TIME to TIME
  std::string bits();         // 0s and 1s, _ between

 private:
  std::int64_t term();

  const Vector& vector_;
  const std::vector<std::string>& marks_;
};

// A step, or nothing for an empty line. A mark that it sets is added to `marks`.
std::optional<Step> parse_step(int line, std::string_view text, const Vector& vector, std::vector<std::string>& marks);

}  // namespace brick
