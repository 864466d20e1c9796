#include "testbench/host/host_link.h"

#include <algorithm>
#include <utility>

#include "testbench/host/framing_probe.h"

namespace brick {

namespace {
constexpr Tick kConnectQuiet = ns_to_ticks(2'000'000);
}

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

Reply HostLink::collect(ReplyParser parser, Tick timeout) {
  std::size_t taken = 0;
  Tick deadline = bus_.now() + timeout;
  for (;;) {
    if (taken < incoming_.size()) deadline = bus_.now() + timeout;
    while (taken < incoming_.size() && !parser.complete()) parser.take(static_cast<std::uint8_t>(incoming_[taken++]));
    if (parser.complete() || taken >= kLongestReply) break;
    if (receive(parser.ends_by_quiet() ? std::min(deadline, bus_.now() + kQuietTime) : deadline)) continue;
    if (parser.quiet() || bus_.now() >= deadline || bus_.tripped()) break;
  }
  incoming_.erase(0, taken);
  return parser.reply();
}

// A line that changes I3 or I4 may be acknowledged by the old setting or by the new one, or not at all.
Reply HostLink::collect_and_ask() {
  while (incoming_.size() < kLongestReply && receive(bus_.now() + kQuietTime)) {}
  const Framing before = framing_;
  const bool known = ask_framing(may_take_long(sent_) ? kSaveTime : kReplyTime);
  const bool sums = before.checksums() || framing_.checksums();
  ReplyParser parser(before, command_checksum(sent_),
                     sums ? ReplyParser::Mixed::kWithChecksums : ReplyParser::Mixed::kWithoutChecksums);
  for (const char c : std::exchange(incoming_, "")) parser.take(static_cast<std::uint8_t>(c));
  parser.quiet();
  Reply reply = parser.reply();
  reply.complete = known;
  return reply;
}

Reply HostLink::finish(Tick timeout) {
  Reply reply;
  if (may_change_framing(sent_)) {
    reply = collect_and_ask();
  } else {
    reply = collect(ReplyParser(framing_, command_checksum(sent_)), timeout);
    const bool silent = reply.complete && framing_.i3 == 0 && may_take_long(sent_);  // it may not even have begun
    const bool lost = !reply.complete && !bus_.tripped() && reply.raw.size() < kLongestReply;
    const Framing before = framing_;
    if ((silent || lost) && ask_framing(silent ? kSaveTime : 4 * kQuietTime) && !(framing_ == before)) {
      ReplyParser parser(framing_, command_checksum(sent_));  // a program has changed I3 or I4
      for (const char c : reply.raw + std::exchange(incoming_, "")) parser.take(static_cast<std::uint8_t>(c));
      parser.quiet();
      reply = parser.reply();
    }
  }
  unsolicited_.insert(unsolicited_.end(), reply.unsolicited.begin(), reply.unsolicited.end());
  return reply;
}

Reply HostLink::command(const std::string& line) { return command(line, may_take_long(line) ? kSaveTime : kReplyTime); }

Reply HostLink::command(const std::string& line, Tick timeout) {
  if (!send(line, may_take_long(sent_) ? kSaveTime : timeout)) return {};
  return may_restart(line) ? restarted() : finish(timeout);
}

// Data of what stood before the restart, and an error there, which means that it was never reached.
Reply HostLink::restarted() {
  const bool sums = framing_.checksums() || may_change_framing(sent_);
  const auto mixed = sums ? ReplyParser::Mixed::kWithChecksums : ReplyParser::Mixed::kWithoutChecksums;
  Reply reply = collect(ReplyParser(framing_, command_checksum(sent_), mixed), kQuietTime);
  if (reply.error) return reply;
  incoming_.clear();
  reply.complete = connect(kBootTime);
  return reply;
}

Reply HostLink::control(std::uint8_t c) {
  poll();
  Reply reply;
  if (!put(c, bus_.now() + kReplyTime)) return reply;
  ReplyParser parser(framing_, std::nullopt);
  while (receive(bus_.now() + kQuietTime)) {
    for (const char byte : incoming_) parser.take(static_cast<std::uint8_t>(byte));
    incoming_.clear();
    if (parser.complete()) break;
  }
  parser.quiet();
  reply = parser.reply();
  if (may_change_framing({reinterpret_cast<const char*>(&c), 1})) ask_framing(kReplyTime);
  reply.complete = true;  // no answer is an answer to most control characters
  return reply;
}

// ------------------------------------------------------------------------------------------------------------- framing

// What comes before the answer stays in incoming_. False when there is none. It is asked again only where something
// else came: an answer that is late must not come twice.
bool HostLink::ask_framing(Tick timeout) {
  const Tick deadline = bus_.now() + timeout;
  std::size_t begin;
  do {
    begin = incoming_.size();
    if (!put(kAskFraming, deadline) || !receive(deadline)) return false;
    while (incoming_.size() < kLongestReply && receive(bus_.now() + kQuietTime)) {}
    if (const auto answer = framing_answer(incoming_, begin)) {
      incoming_.erase(answer->begin);
      framing_ = answer->framing;
      return true;
    }
  } while (incoming_.size() > begin && incoming_.size() < kLongestReply && !bus_.tripped());
  return false;
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
  framing_ = {2, 0};
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
