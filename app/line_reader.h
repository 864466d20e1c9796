// One line of a text that people write, cut into words and taken apart from left to right: lines of host scripts, steps
// of timing vectors. Every mistake is a UsageError that says what was found and what was expected; whoever knows file
// and line puts them in front.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "systemc/core/ticks.h"

namespace brick {

class LineReader {
 public:
  // Words are runs of letters, digits and _ . $ : @, texts in quotation marks, <<, and single other characters.
  // `comment`: the character that begins one, if the text can have any.
  explicit LineReader(std::string_view text, char comment = '\0');

  bool at_end() const { return next_ == words_.size(); }
  std::string peek() const { return at_end() ? "" : words_[next_]; }
  bool take(std::string_view word);  // the next word, if it is this one in capitals or small letters
  void expect(std::string_view word);
  void end();
  std::string word(std::string_view expected);    // whatever comes next
  std::string name(std::string_view expected);    // begins with a letter
  std::string quoted(std::string_view expected);  // a text in quotation marks, without them

  std::int64_t number(std::string_view expected);  // decimal, or hexadecimal with $ or 0x; - in front; _ between digits
  std::int64_t number(std::int64_t low, std::int64_t high, std::string_view expected);
  std::uint32_t hex(std::uint32_t high, std::string_view expected);  // hexadecimal without a mark
  TimeFs time();                                                     // 10ms, 2.5us, 400 ns
  bool time_follows() const;                                         // a number, then a unit of time

  std::size_t place() const { return next_; }
  [[noreturn]] void fail(std::string_view expected) const;  // at the next word
  // From the word at `begin` to the next one, which belong together: `FPD=16`.
  [[noreturn]] void fail_since(std::size_t begin, std::string_view expected) const;

 protected:
  void back_to(std::size_t place) { next_ = place; }

 private:
  std::vector<std::string> words_;
  std::size_t next_ = 0;
};

}  // namespace brick
