#include "testbench/host/host_link.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace brick {

namespace {
constexpr Tick kConnectQuiet = ns_to_ticks(2'000'000), kAskAgain = ns_to_ticks(100'000'000);
constexpr Tick kTextPause = ns_to_ticks(1'000'000);  // a line of text that goes on does so sooner
constexpr std::size_t kMostStray = 1 << 16;          // bytes read without a pause: a program may send for ever
constexpr unsigned kMostQuestions = 5;               // where answers cannot be told from texts
constexpr const char* kUnclear =
    "I3 and I4 cannot be told: a program sends lines of eight words of 12 hexadecimal digits, as ^B is answered; "
    "expected other texts, or I64=1";

std::size_t questions_in(std::string_view line) {
  return static_cast<std::size_t>(std::count(line.begin(), line.end(), kAskFraming));
}

// Where some of the answers from `first` on are acknowledged, the others are texts of programs.
void drop_texts(std::vector<FramingAnswer>& answers, std::size_t first) {
  const auto begin = answers.begin() + static_cast<std::ptrdiff_t>(std::min(first, answers.size()));
  const auto is_text = [](const FramingAnswer& answer) { return answer.framing.i3 < 2; };
  if (!std::all_of(begin, answers.end(), is_text))
    answers.erase(std::remove_if(begin, answers.end(), is_text), answers.end());
}
}  // namespace

// ---------------------------------------------------------------------------------------------------------- characters

// The status register is read once for both directions, so that an answer never waits behind a character to be sent.
bool HostLink::put(std::uint8_t c, Tick deadline) {
  Tick begin = bus_.now();
  for (;;) {
    const std::uint8_t status = bus_.port_status();
    if (status & HostBus::kRxdf) {
      keep(bus_.io_read(regs::host_io::kData7));
      begin = bus_.now();
    }
    if (status & HostBus::kTxde) break;
    if (bus_.now() >= deadline || bus_.tripped()) return false;
    bus_.pause_polling(begin, deadline);
  }
  bus_.io_write(regs::host_io::kData7, c);
  return true;
}

bool HostLink::receive(Tick deadline) {
  const auto c = bus_.get_char(std::max<Tick>(0, deadline - bus_.now()));
  if (c) keep(*c);
  return c.has_value();
}

void HostLink::keep(std::uint8_t c) {
  incoming_.push_back(static_cast<char>(c));
  received_ = bus_.now();
}

void HostLink::poll() {
  while (incoming_.size() < kMostStray && (bus_.port_status() & HostBus::kRxdf))
    keep(bus_.io_read(regs::host_io::kData7));
  look_for_late_checksum();
  take_stray();
}

// Text that came without being asked for: whole lines, and what has ended without a CR. The beginning of a line that is
// coming stays: its end will stand in the reply.
void HostLink::take_stray() {
  const bool sums = framing_.checksums();
  std::size_t taken = 0;
  const auto text_to = [&](std::size_t end) {
    std::copy_if(incoming_.begin() + static_cast<std::ptrdiff_t>(taken),
                 incoming_.begin() + static_cast<std::ptrdiff_t>(end), std::back_inserter(stray_),
                 [](unsigned char c) { return c >= ' '; });
    taken = end;
  };
  for (std::size_t cr = incoming_.find('\r'); cr != std::string::npos && cr + (sums ? 1 : 0) < incoming_.size();
       cr = incoming_.find('\r', taken)) {
    const std::string_view line = std::string_view(incoming_).substr(taken, cr + 1 - taken);
    const bool summed = sums && (incoming_[cr + 1] == sum_of(line) || !may_be_error(line));
    text_to(cr);
    unsolicited_.push_back(std::exchange(stray_, ""));
    taken = cr + 1 + (summed ? 1 : 0);
  }
  if (bus_.now() - received_ > kTextPause) text_to(incoming_.size());
  incoming_.erase(0, taken);
}

// Where a text has begun, its end is waited for; if none comes it has ended already.
void HostLink::poll_to_end_of_text() {
  const Tick limit = bus_.now() + kRestless;
  for (poll(); !incoming_.empty() && bus_.now() < limit && receive(bus_.now() + 2 * kTextPause); poll()) {}
  take_stray();
}

std::vector<std::string> HostLink::take_unsolicited() { return std::exchange(unsolicited_, {}); }

// --------------------------------------------------------------------------------------------------------------- lines

// What has come before the CR answers no line, unless control characters in it asked.
bool HostLink::send(const std::string& line, Tick timeout) {
  poll_to_end_of_text();
  const Tick deadline = bus_.now() + timeout;
  for (const char c : line)
    if (!put(static_cast<std::uint8_t>(c), deadline)) return false;
  look_for_late_checksum();
  if (!has_control_characters(line)) take_stray();
  sent_ = line;
  acknowledged_ = false;
  return put('\r', deadline);
}

// Ends also where it is never quiet: then programs send all the time, and the end is to be asked for.
ReplyParser HostLink::collect(ReplyParser parser, Tick timeout) {
  std::size_t taken = 0;
  Tick deadline = bus_.now() + timeout, busy_since = bus_.now();
  bool by_quiet = false;
  for (;;) {
    if (taken < incoming_.size()) deadline = bus_.now() + timeout;
    while (taken < incoming_.size() && !parser.complete())
      taken += parser.take(static_cast<std::uint8_t>(incoming_[taken])) ? 1 : 0;
    if (parser.complete() || taken >= kLongestReply) break;
    const Tick now = bus_.now();
    if (!std::exchange(by_quiet, parser.ends_by_quiet() || timeout <= kQuietTime) && by_quiet) busy_since = now;
    if (now - busy_since > (by_quiet ? kRestless : timeout)) break;
    const bool more = receive(by_quiet ? std::min(deadline, now + kQuietTime) : deadline);
    if (bus_.now() - now >= kQuietTime) busy_since = bus_.now();
    if (!more && (parser.quiet() || bus_.now() >= deadline || bus_.tripped())) break;
  }
  incoming_.erase(0, taken);
  return parser;
}

// Each control character may be answered with a checksum of its own, and change the line's.
HostLink::Checksum HostLink::sum_of_sent() const {
  if (has_control_characters(sent_)) return std::nullopt;
  return command_checksum(sent_);
}

Reply HostLink::finish(Tick timeout) {
  const bool unlike_others = may_change_framing(sent_) || has_control_characters(sent_);
  const bool ends_by_asking = unlike_others || framing_.i3 == 0;  // without acknowledge it may not even have begun
  const Tick longest = may_take_long(sent_) ? kSaveTime : kReplyTime;
  const Checksum sum = sum_of_sent();
  Reply reply = ends_by_asking ? asked(sum, unlike_others, longest, questions_in(sent_))
                               : confirmed(collect(ReplyParser(framing_, sum), timeout), sum);
  conclude(reply, sum);
  return reply;
}

Reply HostLink::command(const std::string& line) { return command(line, may_take_long(line) ? kSaveTime : kReplyTime); }

Reply HostLink::command(const std::string& line, Tick timeout) {
  if (!send(line, may_take_long(sent_) ? kSaveTime : timeout)) return {};
  return may_restart(line) ? restarted() : finish(timeout);
}

// Data of what stood before the restart, and an error there, which means that it was never reached. However long that
// takes: what answers ^B has done with the line.
Reply HostLink::restarted() {
  const Tick longest = may_take_long(sent_) ? kSaveTime : kReplyTime;
  Reply reply = asked(sum_of_sent(), true, longest + kBootTime, questions_in(sent_));
  if (reply.error) return reply;
  while (!reply.raw.empty() && reply.raw.back() != '\r') reply.raw.pop_back();  // the restart's acknowledge
  incoming_.clear();
  reply.doubt.clear();
  reply.complete = connect(kBootTime);
  return reply;
}

Reply HostLink::control(std::uint8_t c) {
  constexpr std::uint8_t kRepeat = 0x09;
  poll_to_end_of_text();
  acknowledged_ = false;
  if (!put(c, bus_.now() + kReplyTime)) return {};
  const bool is_line = c == kRepeat;
  Reply reply =
      asked(std::nullopt, is_line, is_line ? kSaveTime : kReplyTime, questions_in({reinterpret_cast<char*>(&c), 1}));
  conclude(reply, std::nullopt);
  reply.complete = true;  // no answer is an answer to most control characters
  return reply;
}

// ------------------------------------------------------------------------------------------------------------- framing

// `mixed`: I3 and I4 may have changed half-way.
Reply HostLink::parsed(const std::string& bytes, Checksum command, const Framing& before, bool mixed) const {
  const bool sums = before.checksums() || framing_.checksums() || may_change_framing(sent_);
  using Mixed = ReplyParser::Mixed;
  const Mixed kind = framing_.checksums() ? Mixed::kWithChecksums : sums ? Mixed::kOfLines : Mixed::kWithoutChecksums;
  ReplyParser parser(mixed ? before : framing_, command, mixed ? kind : Mixed::kNo);
  for (const char c : bytes) {
    if (!mixed && parser.complete()) break;
    (void)parser.take(static_cast<std::uint8_t>(c));
  }
  parser.quiet();
  return parser.reply();
}

Reply HostLink::taken(Reply reply, const std::string& bytes) {
  incoming_.insert(0, bytes, reply.raw.size(), std::string::npos);
  reply.doubt = std::exchange(doubt_, "");
  return reply;
}

// The reply is what comes before the answer to ^B; `own`: the line's own, which are answered first.
Reply HostLink::asked(Checksum command, bool mixed, Tick timeout, std::size_t own) {
  const Framing before = framing_;
  const auto answered = ask_framing(timeout, 0, own);
  const std::string bytes = answered ? *answered : std::exchange(incoming_, "");
  Reply reply = taken(parsed(bytes, command, before, mixed || !(framing_ == before)), bytes);
  reply.complete = answered.has_value();
  return reply;
}

// A reply that looks as if a program had changed I3 or I4, or has no end among what programs send: is that so?
Reply HostLink::confirmed(const ReplyParser& parser, Checksum command) {
  const Reply& reply = parser.reply();
  const bool lost = !reply.complete && (command || !reply.raw.empty());  // most control characters have no answer
  const bool odd = parser.maybe_checksums() || !reply.bad_checksum.empty();
  if (!(lost || odd) || bus_.tripped() || reply.raw.size() >= kLongestReply) return reply;
  const Framing before = framing_;
  incoming_.insert(0, reply.raw);
  const auto answered = ask_framing(4 * kQuietTime, incoming_.size());
  const std::string bytes = answered ? *answered : std::exchange(incoming_, "");
  const bool same = framing_ == before;
  if (same && !lost) return taken(reply, bytes);
  Reply again = parsed(bytes, command, before, false);
  if (answered && same && framing_.i3 < 2 && !bytes.empty()) again.complete = true;
  if (same || (again.complete && again.bad_checksum.empty())) return taken(again, bytes);
  return taken(parsed(bytes, command, before, true), bytes);
}

// Where a program has set I4, a byte follows the acknowledge of a line without data.
void HostLink::conclude(const Reply& reply, Checksum command) {
  unsolicited_.insert(unsolicited_.end(), reply.unsolicited.begin(), reply.unsolicited.end());
  acknowledged_ = reply.complete && !reply.error && !framing_.checksums();
  acknowledged_sum_ = command;
}

void HostLink::look_for_late_checksum() {
  if (incoming_.empty() || !std::exchange(acknowledged_, false)) return;
  const auto byte = static_cast<std::uint8_t>(incoming_[0]);
  if (byte != acknowledged_sum_.value_or(byte)) return;
  if (const auto before = ask_framing(kReplyTime, incoming_.size()))
    incoming_.insert(0, *before, framing_.checksums() ? 1 : 0);
}

// What came before the answer; what comes behind it stays in incoming_. Nothing: there is none. It is asked again where
// something else came and where nothing came for long, as the question may have been lost in a restart; all that were
// asked are waited for, and the last answer counts. Where programs send, an answer is not the last that comes: there it
// is asked until a question brings one answer. Then those before it have been answered too.
std::optional<std::string> HostLink::ask_framing(Tick timeout, std::size_t begin, std::size_t own) {
  const Tick deadline = bus_.now() + timeout;
  std::size_t seen = 0;
  bool fresh = false;
  doubt_.clear();
  for (unsigned unclear = 0; incoming_.size() < kLongestReply && !bus_.tripped();) {
    const Tick again = bus_.now() + kAskAgain, limit = fresh ? again : deadline;
    if (bus_.now() >= limit || !put(kAskFraming, limit)) break;
    ++unanswered_;
    fresh = false;
    if (!receive(std::min(limit, again))) continue;
    std::vector<FramingAnswer> answers;
    std::size_t all;
    bool at_end;
    do {
      const bool quiet = read_answer();
      answers = framing_answers(incoming_, begin);
      answers.erase(answers.begin(), answers.begin() + static_cast<std::ptrdiff_t>(std::min(own, answers.size())));
      all = answers.size();
      drop_texts(answers, seen);
      at_end = quiet && !answers.empty() && answers.back().end == incoming_.size();
    } while (at_end && answers.size() < unanswered_ && !may_restart(sent_) && receive(bus_.now() + kAskAgain));
    if (at_end || (seen > 0 && answers.size() == seen + 1)) return take_answer(answers);
    fresh = all > seen;
    seen = all;
    if (!fresh || ++unclear < kMostQuestions) continue;
    doubt_ = kUnclear;
    break;
  }
  return std::nullopt;
}

// True when nothing more comes; false where there is always more, but none of it looks like an answer.
bool HostLink::read_answer() {
  std::optional<Tick> first, last;
  while (incoming_.size() < kLongestReply) {
    if (!receive(bus_.now() + kQuietTime)) return true;
    if (may_end_answer(incoming_)) {
      last = bus_.now();
      if (!first) first = last;
    }
    if (last && (bus_.now() - *last > kRestless || bus_.now() - *first > kAskAgain)) break;
  }
  return false;
}

// Of answers to several questions the first ends the reply; texts between them are none of it.
std::string HostLink::take_answer(const std::vector<FramingAnswer>& answers) {
  framing_ = answers.back().framing;
  std::size_t end = incoming_.size();
  std::string behind;
  for (auto a = answers.rbegin(); a != answers.rend() && unanswered_ > 0; ++a) {
    if (!(a->framing == framing_)) continue;
    --unanswered_;
    if (a->end < end) behind.insert(0, incoming_, a->end, end - a->end);
    end = a->begin;
  }
  unanswered_ = 0;
  incoming_.erase(end);
  return std::exchange(incoming_, behind);
}

// ------------------------------------------------------------------------------------------------------------- connect

// Before this the framing is not known, so the answer is only waited for until the line is quiet; then I3 is asked for.
bool HostLink::try_connect(Tick deadline) {
  incoming_.clear();
  for (const char c : std::string("I6=1I3=2I4=0\r"))
    if (!put(static_cast<std::uint8_t>(c), deadline)) return false;
  if (incoming_.empty() && !receive(std::min(deadline, bus_.now() + kReplyTime))) return false;
  const Tick begin = bus_.now();
  bool quiet = false;
  while (!quiet && bus_.now() < deadline && bus_.now() - begin < kRestless)
    quiet = !receive(std::min(deadline, bus_.now() + kConnectQuiet));
  if (!quiet && !ask_framing(std::max<Tick>(1, deadline - bus_.now()), incoming_.size())) return false;
  incoming_.clear();
  framing_ = {2, 0};
  if (!send("I3", std::max<Tick>(1, deadline - bus_.now()))) return false;
  const Reply reply = finish(std::min(kReplyTime, std::max<Tick>(1, deadline - bus_.now())));
  if (!reply.complete || reply.error || reply.lines.empty()) return false;
  return reply.lines.back() == "2" || reply.lines.back() == "I3=2";  // behind what programs send
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
