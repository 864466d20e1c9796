#include "testbench/host/reply_parser.h"

#include <utility>

#include <fmt/format.h>

namespace brick {

namespace {
constexpr char kStx = 0x02, kAck = 0x06, kBell = 0x07, kLf = 0x0A, kCr = 0x0D;
}

std::uint8_t command_checksum(std::string_view line) {
  unsigned sum = 0;
  for (const unsigned char c : line)
    if (c >= ' ') sum += c;
  return static_cast<std::uint8_t>(sum);
}

// No source says whether an error has a checksum, or of what: its line, with BELL and what else stands before it, or
// the command.
bool ReplyParser::may_be_of_error(std::uint8_t byte) const {
  unsigned line = kCr;
  for (const unsigned char c : reply_.lines.back()) line += c;
  for (const int before : {0, +kBell, +kLf, kBell + kLf, kBell + kCr, kBell + kCr + kLf})
    if (byte == static_cast<std::uint8_t>(line + static_cast<unsigned>(before))) return true;
  return byte == command_;
}

// True when the byte was one.
bool ReplyParser::take_checksum(std::uint8_t byte) {
  const Due due = std::exchange(due_, Due::kNothing);
  if (due == Due::kNothing) return false;
  const std::uint8_t sum = std::exchange(sum_, std::uint8_t{0});
  if (due == Due::kProgramError) {
    if (byte == sum) ++right_;
    return byte == sum;
  }
  if (due == Due::kError) {
    reply_.complete = !mixed_;
    return may_be_of_error(byte);
  }
  const std::uint8_t expected = due == Due::kLine ? sum : command_.value_or(byte);
  if (mixed_ && due == Due::kCommand && !command_ && !summed_) {
    handshake_ = true;  // what comes next shows whether it is one
    return false;
  }
  if (due == Due::kLine) summed_ = byte == expected;
  if (mixed_ && byte != expected) return false;
  if (byte == expected) {
    ++right_;
  } else {
    misread_ = true;
    text_.push_back(static_cast<char>(byte));
  }
  if (byte != expected && reply_.bad_checksum.empty()) {
    const std::string whose = due == Due::kLine && !reply_.lines.empty() ? "`" + reply_.lines.back() + "`" : "the line";
    reply_.bad_checksum = fmt::format("the checksum of {} is ${:02X}, expected ${:02X}", whose, byte, expected);
  }
  if (due == Due::kCommand) reply_.complete = !mixed_;
  return true;
}

// Ends a line; says whose checksum comes next, if there are any.
ReplyParser::Due ReplyParser::end_line() {
  (tagged_ ? reply_.unsolicited : reply_.lines).push_back(line_);
  const bool has_number = line_.rfind("ERR", 0) == 0, program_error = has_number || line_.empty();
  if (reply_.error && !tagged_ && has_number) numbered_ = true;  // else a program's text behind BELL
  line_.clear();
  if (std::exchange(tagged_, false)) return program_error ? Due::kProgramError : Due::kLine;
  if (numbered_) return error_sums_ ? Due::kError : Due::kNothing;
  return Due::kLine;
}

bool ReplyParser::take(std::uint8_t byte) {
  const char c = static_cast<char>(byte);
  if (reply_.complete && !mixed_) {
    misread_ = true;
    text_.push_back(c);
    return false;
  }
  if (std::exchange(unexpected_, std::nullopt) == byte) maybe_checksums_ = true;
  const bool behind_error = due_ == Due::kError && !mixed_;
  const bool is_checksum = take_checksum(byte);
  if (behind_error && !is_checksum) return false;
  if (const auto held = std::exchange(held_, std::nullopt)) {
    handshake_ = false;
    if (c != kLf && c != kStx && c != kBell && c != kAck) {
      take_text(*held);  // else it was the checksum, and something new begins: a text of a program, an error
      return take(byte);
    }
  }
  reply_.raw.push_back(c);
  if (is_checksum) return true;
  if (handshake_ && sums_ && byte == command_.value_or(byte)) {
    held_ = c;
    return true;
  }
  take_text(c);
  return true;
}

void ReplyParser::take_text(char c) {
  handshake_ = false;
  text_.push_back(c);
  sum_ = static_cast<std::uint8_t>(sum_ + static_cast<unsigned char>(c));
  switch (c) {
    case kAck:
      if (!line_.empty()) (void)end_line();
      if (sums_) due_ = Due::kCommand;
      reply_.complete = !sums_ && !mixed_;
      break;
    case kBell:
      if (!line_.empty()) (void)end_line();
      reply_.error = true;
      sum_ = 0;  // none of the line behind it, which may be a program's
      break;
    case kCr:
      if (line_.empty() && reply_.error) {  // I6 = 3: BELL CR ERRnnn CR
        sum_ = 0;
        break;
      }
      if (const Due due = end_line(); sums_)
        due_ = due;
      else
        unexpected_ = std::exchange(sum_, std::uint8_t{0});
      reply_.complete = numbered_ && error_ends_;
      break;
    case kLf:
      sum_ = static_cast<std::uint8_t>(kLf);
      handshake_ = framing_.i3 == 1 || mixed_;
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

unsigned ReplyParser::error_number() const {
  constexpr std::size_t kBegin = 3;  // behind ERR
  unsigned number = 0;
  if (!numbered_) return number;
  const std::string& text = reply_.lines.back();
  for (std::size_t i = kBegin; i < text.size() && text[i] >= '0' && text[i] <= '9'; ++i)
    number = number * 10 + static_cast<unsigned>(text[i] - '0');
  return number;
}

bool ReplyParser::quiet_is_the_end() {
  if (reply_.error || mixed_ || framing_.i3 == 0 || held_) return true;
  if (framing_.i3 != 1 || !framing_.checksums()) return framing_.i3 == 1 && handshake_;
  // A LF and one character: that should have been the checksum.
  if (line_.size() != 1 || sum_ != static_cast<std::uint8_t>(kLf + line_[0])) return false;
  reply_.bad_checksum = fmt::format("the checksum of the line is ${:02X}, expected ${:02X}",
                                    static_cast<unsigned char>(line_[0]), command_.value_or(0));
  line_.clear();
  return true;
}

bool ReplyParser::quiet() {
  if (reply_.complete || !quiet_is_the_end()) return reply_.complete;
  if (!line_.empty()) (void)end_line();
  if (reply_.error && !numbered_) reply_.lines.emplace_back("ERR");  // I6 = 0, 2
  reply_.complete = true;
  return true;
}

}  // namespace brick
