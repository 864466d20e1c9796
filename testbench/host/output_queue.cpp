#include "testbench/host/output_queue.h"

#include <algorithm>

namespace brick {

namespace {
constexpr char kTag = 0x02, kAcknowledge = 0x06, kBell = 0x07;
}

void OutputQueue::add(std::string_view text) { bytes_ += text.substr(0, kLimit - std::min(size(), kLimit)); }

void OutputQueue::clear() {
  bytes_.clear();
  bytes_.shrink_to_fit();
  at_ = looked_ = 0;
  until_return_ = false;
}

std::string OutputQueue::take(std::size_t most) {
  std::string taken = bytes_.substr(at_, most);
  at_ += taken.size();
  if (at_ == bytes_.size()) clear();
  if (at_ > kLimit / 2) {
    bytes_.erase(0, at_);
    at_ = 0;
  }
  looked_ = at_;
  return taken;
}

std::optional<std::string> OutputQueue::take_answer(std::size_t most) {
  for (; looked_ < bytes_.size() && looked_ - at_ < most; ++looked_) {
    const char c = bytes_[looked_];
    if (c == kAcknowledge || c == '\n' || (until_return_ && c == '\r')) {
      until_return_ = false;
      return take(looked_ + 1 - at_);
    }
    if (c == kBell || c == kTag) until_return_ = true;
  }
  if (looked_ - at_ < most) return std::nullopt;
  const bool inside = until_return_;  // the CR is in the next piece
  std::string taken = take(most);
  until_return_ = inside;
  return taken;
}

std::optional<std::string> OutputQueue::take_line(std::size_t most) {
  const std::size_t end = bytes_.find_first_of("\r\n\x06", at_);
  if (end == std::string::npos && size() < most) return std::nullopt;
  return take(end == std::string::npos ? most : std::min(most, end + 1 - at_));
}

}  // namespace brick
