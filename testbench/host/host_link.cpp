#include "testbench/host/host_link.h"

#include <algorithm>
#include <utility>

#include "testbench/host/framing_probe.h"

namespace brick {

namespace {
constexpr Tick kConnectQuiet = ns_to_ticks(2'000'000), kAskAgain = ns_to_ticks(100'000'000);
constexpr std::size_t kMostStray = 1 << 16;  // bytes read without a pause: a program may send for ever
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
  while (incoming_.size() < kMostStray && (bus_.port_status() & HostBus::kRxdf))
    incoming_.push_back(static_cast<char>(bus_.io_read(regs::host_io::kData7)));
  look_for_late_checksum();
  take_stray(incoming_.size());
}

// Text that came without being asked for, up to `end`.
void HostLink::take_stray(std::size_t end) {
  for (const char c : incoming_.substr(0, end)) {
    if (c == '\r') {
      unsolicited_.push_back(stray_);
      stray_.clear();
    } else if (static_cast<unsigned char>(c) >= ' ') {
      stray_.push_back(c);
    }
  }
  incoming_.erase(0, end);
}

std::vector<std::string> HostLink::take_unsolicited() { return std::exchange(unsolicited_, {}); }

// --------------------------------------------------------------------------------------------------------------- lines

// What has come before the CR answers no line, unless control characters in it asked.
bool HostLink::send(const std::string& line, Tick timeout) {
  poll();
  const Tick deadline = bus_.now() + timeout;
  for (const char c : line)
    if (!put(static_cast<std::uint8_t>(c), deadline)) return false;
  look_for_late_checksum();
  if (!has_control_characters(line)) take_stray(incoming_.rfind('\r') + 1);
  sent_ = line;
  acknowledged_ = false;
  return put('\r', deadline);
}

ReplyParser HostLink::collect(ReplyParser parser, Tick timeout) {
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
  return parser;
}

Reply HostLink::finish(Tick timeout) {
  const bool unlike_others = may_change_framing(sent_) || has_control_characters(sent_);
  const bool ends_by_asking = unlike_others || framing_.i3 == 0;  // without acknowledge it may not even have begun
  const Tick longest = may_take_long(sent_) ? kSaveTime : kReplyTime;
  const std::uint8_t sum = command_checksum(sent_);
  Reply reply = ends_by_asking ? asked(sum, unlike_others, longest)
                               : confirmed(collect(ReplyParser(framing_, sum), timeout), sum);
  unsolicited_.insert(unsolicited_.end(), reply.unsolicited.begin(), reply.unsolicited.end());
  expect_late_checksum(reply, sum);
  return reply;
}

Reply HostLink::command(const std::string& line) { return command(line, may_take_long(line) ? kSaveTime : kReplyTime); }

Reply HostLink::command(const std::string& line, Tick timeout) {
  if (!send(line, may_take_long(sent_) ? kSaveTime : timeout)) return {};
  return may_restart(line) ? restarted() : finish(timeout);
}

// Data of what stood before the restart, and an error there, which means that it was never reached. However long that
// takes: what answers ^G has done with the line.
Reply HostLink::restarted() {
  const Tick longest = may_take_long(sent_) ? kSaveTime : kReplyTime;
  Reply reply = asked(command_checksum(sent_), true, longest + kBootTime);
  if (reply.error) return reply;
  while (!reply.raw.empty() && reply.raw.back() != '\r') reply.raw.pop_back();  // the restart's acknowledge
  incoming_.clear();
  reply.complete = connect(kBootTime);
  return reply;
}

Reply HostLink::control(std::uint8_t c) {
  constexpr std::uint8_t kRepeat = 0x09;
  poll();
  acknowledged_ = false;
  if (!put(c, bus_.now() + kReplyTime)) return {};
  Reply reply = c == kRepeat ? asked(std::nullopt, true, kSaveTime)
                             : confirmed(collect(ReplyParser(framing_, std::nullopt), kQuietTime), std::nullopt);
  expect_late_checksum(reply, std::nullopt);
  reply.complete = true;  // no answer is an answer to most control characters
  return reply;
}

// ------------------------------------------------------------------------------------------------------------- framing

// `mixed`: I3 and I4 may have changed half-way.
Reply HostLink::parsed(const std::string& bytes, Checksum command, const Framing& before, bool mixed) const {
  const bool sums = before.checksums() || framing_.checksums() || may_change_framing(sent_);
  const auto kind = sums ? ReplyParser::Mixed::kWithChecksums : ReplyParser::Mixed::kWithoutChecksums;
  ReplyParser parser(mixed ? before : framing_, command, mixed ? kind : ReplyParser::Mixed::kNo);
  for (const char c : bytes) parser.take(static_cast<std::uint8_t>(c));
  parser.quiet();
  return parser.reply();
}

// The reply is what comes before the answer to ^G.
Reply HostLink::asked(Checksum command, bool mixed, Tick timeout) {
  const Framing before = framing_;
  const bool known = ask_framing(timeout);
  Reply reply = parsed(std::exchange(incoming_, ""), command, before, mixed || !(framing_ == before));
  reply.complete = known;
  return reply;
}

// A reply that looks as if a program had changed I3 or I4: is that so?
Reply HostLink::confirmed(const ReplyParser& parser, Checksum command) {
  const Reply& reply = parser.reply();
  const bool lost = !reply.complete && (command || !reply.raw.empty());  // most control characters have no answer
  const bool odd = parser.maybe_checksums() || !reply.bad_checksum.empty();
  if (!(lost || odd) || bus_.tripped() || reply.raw.size() >= kLongestReply) return reply;
  const Framing before = framing_;
  if (!ask_framing(4 * kQuietTime) || framing_ == before) return reply;
  const std::string bytes = reply.raw + std::exchange(incoming_, "");
  Reply again = parsed(bytes, command, before, false);
  return again.complete && again.bad_checksum.empty() ? again : parsed(bytes, command, before, true);
}

// Where a program has set I4, a byte follows the acknowledge of a line without data.
void HostLink::expect_late_checksum(const Reply& reply, Checksum command) {
  acknowledged_ = reply.complete && !reply.error && !framing_.checksums();
  acknowledged_sum_ = command;
}

void HostLink::look_for_late_checksum() {
  if (incoming_.empty() || !std::exchange(acknowledged_, false)) return;
  const auto byte = static_cast<std::uint8_t>(incoming_[0]);
  if (byte == acknowledged_sum_.value_or(byte) && ask_framing(kReplyTime) && framing_.checksums())
    incoming_.erase(0, 1);
}

// What comes before the answer stays in incoming_. False when there is none. It is asked again where something else
// came and where nothing came for long, as the question may have been lost in a restart; of several answers the last
// counts.
bool HostLink::ask_framing(Tick timeout) {
  const Tick deadline = bus_.now() + timeout;
  const std::size_t begin = incoming_.size();
  while (bus_.now() < deadline && incoming_.size() < kLongestReply && !bus_.tripped()) {
    if (!put(kAskFraming, deadline)) return false;
    ++unanswered_;
    if (!receive(std::min(deadline, bus_.now() + kAskAgain))) continue;
    while (incoming_.size() < kLongestReply && receive(bus_.now() + kQuietTime)) {}
    if (const auto answer = framing_answer(incoming_, begin)) {
      framing_ = answer->framing;
      incoming_ = without_answers(incoming_.substr(0, answer->begin), begin, framing_, unanswered_ - 1);
      unanswered_ = 0;
      return true;
    }
  }
  return false;
}

// ------------------------------------------------------------------------------------------------------------- connect

// Before this the framing is not known, so the answer is only waited for until the line is quiet; then I3 is asked for.
bool HostLink::try_connect(Tick deadline) {
  incoming_.clear();
  for (const char c : std::string("I6=1I3=2I4=0\r"))
    if (!put(static_cast<std::uint8_t>(c), deadline)) return false;
  if (incoming_.empty() && !receive(std::min(deadline, bus_.now() + kReplyTime))) return false;
  while (bus_.now() < deadline && receive(std::min(deadline, bus_.now() + kConnectQuiet))) {}
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
      unanswered_ = 0;
      acknowledged_ = false;
      return true;
    }
  } while (bus_.now() < deadline && !bus_.tripped());
  return false;
}

}  // namespace brick
