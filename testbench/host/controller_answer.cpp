#include "testbench/host/controller_answer.h"

#include <string_view>

namespace brick {

namespace {

constexpr unsigned kCertain = 3;  // so many checksums are not right by chance

bool ends_with(const std::string& text, std::string_view end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

void ControllerAnswer::take(std::uint8_t c) {
  empty_ = false;
  if (choice_ != Choice::kSummed) (void)plain_.take(c);
  if (choice_ != Choice::kPlain) (void)summed_.take(c);
  if (choice_ == Choice::kOpen) decide();
}

void ControllerAnswer::decide() {
  const unsigned right = summed_.right_checksums();
  if (summed_.misread())
    choice_ = Choice::kPlain;
  else if (plain_.misread() || right >= kCertain || (summed_.complete() && right > 0))
    choice_ = Choice::kSummed;
  else if (plain_.complete() && (summed_.complete() || (right == 0 && !expects_sums_)))
    choice_ = Choice::kPlain;
}

bool ControllerAnswer::ended() const { return ended_ || (choice_ != Choice::kOpen && chosen().complete()); }

bool ControllerAnswer::ends_with_checksum(const ReplyParser& parser) const {
  const char end[] = {'\n', static_cast<char>(command_sum_)};
  return ends_with(parser.text(), {end, sizeof end});
}

bool ControllerAnswer::may_have_ended() const {
  const ReplyParser& parser = chosen();
  return parser.complete() || parser.bare_error() || ends_with(parser.text(), "\n") || ends_with_checksum(parser);
}

void ControllerAnswer::quiet() {
  if (ended()) return;
  ended_ = true;
  const bool sum = choice_ != Choice::kPlain && ends_with_checksum(summed_);
  if (choice_ == Choice::kOpen) {
    const bool sums = sum || (summed_.right_checksums() > 0 && !plain_.complete());
    choice_ = sums ? Choice::kSummed : Choice::kPlain;
  }
  drops_last_ = sum;
}

std::string ControllerAnswer::release() {
  if (choice_ == Choice::kOpen) return "";
  const bool may_be_sum = !ended_ && choice_ == Choice::kSummed && ends_with_checksum(summed_);
  const std::string& text = chosen().text();
  std::string more = text.substr(released_, text.size() - released_ - (may_be_sum || drops_last_ ? 1 : 0));
  released_ += more.size();
  return more;
}

}  // namespace brick
