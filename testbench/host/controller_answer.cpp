#include "testbench/host/controller_answer.h"

#include <utility>

namespace brick {

namespace {
constexpr std::uint8_t kAcknowledge = 0x06, kBell = 0x07, kLineFeed = 0x0A, kReturn = 0x0D;
constexpr unsigned kCertain = 3;  // so many checksums are not right by chance
}  // namespace

// ------------------------------------------------------------------------------------------------------------- reading

void ControllerAnswer::Reading::take(std::uint8_t c) {
  switch (place) {
    case Place::kText:
      return take_text(c);
    case Place::kError:
      return take_error(c);
    case Place::kLineSum:
      return take_sum(c, std::exchange(line_sum, std::uint8_t{0}), Place::kText);
    case Place::kCommandSum:
      return take_sum(c, command_sum, Place::kEnd);
    case Place::kEnd:
      wrong = true;
      text.push_back(static_cast<char>(c));
  }
}

void ControllerAnswer::Reading::take_text(std::uint8_t c) {
  text.push_back(static_cast<char>(c));
  line_sum = static_cast<std::uint8_t>(line_sum + c);
  if (c == kAcknowledge) {
    place = sums ? Place::kCommandSum : Place::kEnd;
  } else if (c == kBell) {
    error = true;
    error_text.clear();
    place = Place::kError;
  } else if (c == kReturn) {
    if (sums)
      place = Place::kLineSum;
    else
      line_sum = 0;
  }
}

// BEL alone, or with ERRnnn and CR behind it, before which CR or LF may stand (I6, I3). An error has no checksum.
void ControllerAnswer::Reading::take_error(std::uint8_t c) {
  if (error_text.empty() && c != kReturn && c != kLineFeed && c != 'E') {
    place = Place::kText;
    line_sum = 0;
    return take_text(c);
  }
  text.push_back(static_cast<char>(c));
  if (c > ' ')
    error_text.push_back(static_cast<char>(c));
  else if (c == kReturn && !error_text.empty())
    place = Place::kEnd;
}

void ControllerAnswer::Reading::take_sum(std::uint8_t c, std::uint8_t expected, Place next) {
  place = next;
  if (c == expected) {
    ++right_sums;
    return;
  }
  wrong = true;
  text.push_back(static_cast<char>(c));
}

bool ControllerAnswer::Reading::ends_with_line_feed(bool sum_behind) const {
  const std::size_t behind = sum_behind ? 1 : 0;
  if (text.size() <= behind || text[text.size() - 1 - behind] != '\n') return false;
  return !sum_behind || static_cast<std::uint8_t>(text.back()) == command_sum;
}

// -------------------------------------------------------------------------------------------------------------- answer

void ControllerAnswer::take(std::uint8_t c) {
  empty_ = false;
  if (choice_ != Choice::kSummed) plain_.take(c);
  if (choice_ != Choice::kPlain) summed_.take(c);
  if (choice_ == Choice::kOpen) decide();
}

void ControllerAnswer::decide() {
  const bool over = plain_.place == Place::kEnd, summed_over = summed_.place == Place::kEnd;
  if (summed_.wrong)
    choice_ = Choice::kPlain;
  else if (plain_.wrong || summed_.right_sums >= kCertain || (summed_over && summed_.right_sums > 0))
    choice_ = Choice::kSummed;
  else if (over && (summed_over || (summed_.right_sums == 0 && !expects_sums_)))
    choice_ = Choice::kPlain;
}

bool ControllerAnswer::ended() const { return ended_ || (choice_ != Choice::kOpen && chosen().place == Place::kEnd); }

bool ControllerAnswer::may_have_ended() const {
  const Reading& reading = chosen();
  return reading.place == Place::kEnd || (reading.place == Place::kError && reading.error_text.empty()) ||
         reading.ends_with_line_feed(false) || reading.ends_with_line_feed(true);
}

void ControllerAnswer::quiet() {
  if (ended()) return;
  ended_ = true;
  if (choice_ != Choice::kPlain && summed_.ends_with_line_feed(true)) {  // the end with I3 = 1
    summed_.text.pop_back();
    ++summed_.right_sums;
  } else if (plain_.place == Place::kEnd && choice_ == Choice::kOpen) {
    choice_ = Choice::kPlain;
  }
  if (choice_ == Choice::kOpen) choice_ = summed_.right_sums > 0 ? Choice::kSummed : Choice::kPlain;
}

std::string ControllerAnswer::release() {
  if (choice_ == Choice::kOpen) return "";
  const bool may_be_sum = !ended_ && choice_ == Choice::kSummed && summed_.ends_with_line_feed(true);
  std::string more = chosen().text.substr(released_, chosen().text.size() - released_ - (may_be_sum ? 1 : 0));
  released_ += more.size();
  return more;
}

unsigned ControllerAnswer::error_number() const {
  const std::string& text = chosen().error_text;
  unsigned number = 0;
  for (std::size_t i = 3; text.compare(0, 3, "ERR") == 0 && i < text.size(); ++i)
    number = number * 10 + static_cast<unsigned>(text[i] - '0');
  return number;
}

}  // namespace brick
