#include "testbench/host/reply_parser.h"

namespace brick {

namespace {
constexpr char kStx = 0x02, kAck = 0x06, kBell = 0x07, kLf = 0x0A, kCr = 0x0D;
}

void ReplyParser::end_line() {
  if (tagged_)
    reply_.unsolicited.push_back(line_);
  else
    reply_.lines.push_back(line_);
  line_.clear();
  tagged_ = false;
}

void ReplyParser::take(std::uint8_t byte) {
  const char c = static_cast<char>(byte);
  reply_.raw.push_back(c);
  if (skip_) {
    skip_ = false;
    reply_.complete = last_;
    return;
  }
  handshake_ = false;
  switch (c) {
    case kAck:
      if (!line_.empty()) end_line();
      skip_ = last_ = framing_.checksums();  // the checksum of the command line follows the acknowledge
      reply_.complete = !last_;
      break;
    case kBell:
      if (!line_.empty()) end_line();
      reply_.error = true;
      if (framing_.i6 % 2 == 0) {  // no number follows
        reply_.lines.emplace_back("ERR");
        reply_.complete = true;
      }
      break;
    case kCr: {
      if (line_.empty() && reply_.error) break;  // I6 = 3: BELL CR ERRnnn CR
      const bool number = reply_.error && !tagged_;
      end_line();
      skip_ = framing_.checksums();
      last_ = number;
      if (number) reply_.complete = !skip_;
      break;
    }
    case kLf:
      handshake_ = true;
      break;
    case kStx:
      if (line_.empty()) {
        tagged_ = true;
        break;
      }
      [[fallthrough]];
    default:
      line_.push_back(c);
  }
}

bool ReplyParser::quiet() {
  if (reply_.complete) return true;
  if (reply_.error) {
    if (!line_.empty()) end_line();
    reply_.complete = true;
  } else if (framing_.i3 == 0) {
    if (!line_.empty()) end_line();
    reply_.complete = true;
  } else if (framing_.i3 == 1) {
    const bool with_checksum = framing_.checksums() && line_.size() == 1;  // LF and the checksum of the command line
    reply_.complete = handshake_ || with_checksum;
    if (with_checksum) line_.clear();
  }
  return reply_.complete;
}

}  // namespace brick
