#include "testbench/host/host_link.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <utility>

namespace brick {

namespace {

constexpr Tick kConnectQuiet = ns_to_ticks(2'000'000);

std::string squeezed(const std::string& line) {
  std::string text;
  for (const unsigned char c : line)
    if (c > ' ') text.push_back(static_cast<char>(std::toupper(c)));
  return text;
}

bool restarts(const std::string& line) { return squeezed(line).rfind("$$$", 0) == 0; }

}  // namespace

// ---------------------------------------------------------------------------------------------------------- characters

// The status register is read once for both directions, so that an answer never waits behind a character to be sent.
bool HostLink::put(std::uint8_t c, Tick deadline) {
  for (;;) {
    const std::uint8_t status = bus_.port_status();
    if (status & HostBus::kRxdf) incoming_.push_back(static_cast<char>(bus_.io_read(regs::host_io::kData7)));
    if (status & HostBus::kTxde) break;
    if (bus_.now() >= deadline || bus_.tripped()) return false;
    bus_.pause_polling();
  }
  bus_.io_write(regs::host_io::kData7, c);
  return true;
}

bool HostLink::receive(Tick deadline) {
  const auto c = bus_.get_char(std::max<Tick>(0, deadline - bus_.now()));
  if (c) incoming_.push_back(static_cast<char>(*c));
  return c.has_value();
}

void HostLink::poll() {
  while (bus_.port_status() & HostBus::kRxdf)
    incoming_.push_back(static_cast<char>(bus_.io_read(regs::host_io::kData7)));
  for (const char c : incoming_) {
    if (c == '\r') {
      unsolicited_.push_back(stray_);
      stray_.clear();
    } else if (static_cast<unsigned char>(c) >= ' ') {
      stray_.push_back(c);
    }
  }
  incoming_.clear();
}

std::vector<std::string> HostLink::take_unsolicited() { return std::exchange(unsolicited_, {}); }

// --------------------------------------------------------------------------------------------------------------- lines

bool HostLink::send(const std::string& line, Tick timeout) {
  poll();
  sent_ = line;
  const Tick deadline = bus_.now() + timeout;
  for (const char c : line)
    if (!put(static_cast<std::uint8_t>(c), deadline)) return false;
  return put('\r', deadline);
}

// A line that assigns I3 or I4 may be acknowledged by the old setting or by the new one: only quiet ends such a reply.
Reply HostLink::finish(Tick timeout) {
  const Framing next = framing_after(sent_);
  const bool changes = next.i3 != framing_.i3 || next.i4 != framing_.i4;
  Framing expected = framing_;
  if (changes) expected = {0, next.i4, framing_.i6};
  ReplyParser parser(expected);
  const Tick deadline = bus_.now() + timeout;
  const bool by_quiet = expected.i3 < 2;
  std::size_t taken = 0;
  for (;;) {
    while (taken < incoming_.size() && !parser.complete()) parser.take(static_cast<std::uint8_t>(incoming_[taken++]));
    if (parser.complete()) break;
    const Tick limit = by_quiet ? std::min(deadline, bus_.now() + kQuietTime) : deadline;
    if (receive(limit)) continue;
    if (parser.quiet() || bus_.now() >= deadline || bus_.tripped()) break;
  }
  incoming_.erase(0, taken);
  Reply reply = parser.reply();
  unsolicited_.insert(unsolicited_.end(), reply.unsolicited.begin(), reply.unsolicited.end());
  if (changes) {  // a checksum that came or not
    while (receive(bus_.now() + kQuietTime)) {}
    incoming_.clear();
  }
  if (reply.complete && !reply.error) framing_ = next;
  return reply;
}

Reply HostLink::command(const std::string& line) {
  return command(line, squeezed(line).find("SAVE") != std::string::npos ? kSaveTime : kReplyTime);
}

Reply HostLink::command(const std::string& line, Tick timeout) {
  if (!send(line, timeout)) return {};
  if (!restarts(line)) return finish(timeout);
  incoming_.clear();
  Reply reply;
  reply.complete = connect(kBootTime);
  return reply;
}

Reply HostLink::control(std::uint8_t c) {
  poll();
  Reply reply;
  if (!put(c, bus_.now() + kReplyTime)) return reply;
  ReplyParser parser(framing_);
  while (receive(bus_.now() + kQuietTime)) {
    for (const char byte : incoming_) parser.take(static_cast<std::uint8_t>(byte));
    incoming_.clear();
    if (parser.complete()) break;
  }
  parser.quiet();
  reply = parser.reply();
  reply.complete = true;  // no answer is an answer to most control characters
  return reply;
}

// ------------------------------------------------------------------------------------------------------------- framing

// What I3, I4 and I6 are once `line` has been executed.
Framing HostLink::framing_after(const std::string& line) const {
  Framing next = framing_;
  const std::string text = squeezed(line);
  const auto follow = [&](const char* name, unsigned& value, unsigned by_default) {
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
      if (at != 0 && std::isalpha(static_cast<unsigned char>(text[at - 1]))) continue;
      const bool hex = text.compare(at + 3, 1, "$") == 0;
      const char* digits = text.c_str() + at + 3 + (hex ? 1 : 0);
      if (*digits == '*') value = by_default;
      // Two bits are kept of whatever is assigned: `I3=5` is `I3=1`.
      const auto first = static_cast<unsigned char>(*digits);
      if (hex ? std::isxdigit(first) : std::isdigit(first)) value = std::strtoul(digits, nullptr, hex ? 16 : 10) & 3u;
    }
  };
  follow("I3=", next.i3, 1);
  follow("I4=", next.i4, 0);
  follow("I6=", next.i6, 3);
  return next;
}

// ------------------------------------------------------------------------------------------------------------- connect

// Before this the framing is not known, so the answer is only waited for until the line is quiet; then I3 is asked for.
bool HostLink::try_connect(Tick deadline) {
  incoming_.clear();
  for (const char c : std::string("I6=1I3=2I4=0\r"))
    if (!put(static_cast<std::uint8_t>(c), deadline)) return false;
  if (incoming_.empty() && !receive(std::min(deadline, bus_.now() + kReplyTime))) return false;
  while (receive(std::min(deadline, bus_.now() + kConnectQuiet))) {}
  incoming_.clear();
  framing_ = {2, 0, 1};
  if (!send("I3", std::max<Tick>(1, deadline - bus_.now()))) return false;
  const Reply reply = finish(std::min(kReplyTime, std::max<Tick>(1, deadline - bus_.now())));
  if (!reply.complete || reply.error || reply.lines.size() != 1) return false;
  return reply.lines[0] == "2" || reply.lines[0] == "I3=2";
}

bool HostLink::connect(Tick timeout) {
  const Tick deadline = bus_.now() + timeout;
  bus_.open_port();
  do {
    if (try_connect(deadline)) {
      stray_.clear();
      unsolicited_.clear();
      return true;
    }
  } while (bus_.now() < deadline && !bus_.tripped());
  return false;
}

}  // namespace brick
