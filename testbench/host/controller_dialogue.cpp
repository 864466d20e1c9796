#include "testbench/host/controller_dialogue.h"

#include <algorithm>
#include <utility>

#include "testbench/host/framing_probe.h"
#include "testbench/host/reply_parser.h"

namespace brick {

namespace {
constexpr std::uint8_t kAskStatus = 0x07;            // ^G
constexpr char kSources = 0x05;                      // ^E
constexpr char kClearInput = 0x18;                   // ^X, and its echo
constexpr std::uint8_t kAskMark = 0x0E, kMark = 0;   // ^N behind an empty line: the sum of nothing
constexpr Tick kMarkQuiet = ns_to_ticks(1'000'000);  // nothing for so long behind a NUL: it was no checksum
constexpr Tick kClearWait = ns_to_ticks(10'000'000), kStartAgain = ns_to_ticks(20'000'000);
}  // namespace

bool is_report_control(std::uint8_t c) {
  return std::string_view("\x02\x03\x06\x07\x10\x16").find(static_cast<char>(c)) != std::string_view::npos;
}

bool is_answered_control(std::uint8_t c) {
  return is_report_control(c) || c == kSources || c == 0x09 || c == 0x0D || c == 0x0E || c == 0x19;  // ^I, CR, ^N, ^Y
}

ControllerDialogue::ControllerDialogue(HostBus& bus) : bus_(bus), port_(bus) {
  port_.on_character = [this](std::uint8_t c) { received(c); };
}

// ^B is answered in every setting. What was sent before the firmware reads is lost, so it is asked again.
bool ControllerDialogue::start(Tick timeout) {
  port_.open();
  bool heard = false;
  port_.on_character = [&](std::uint8_t) { heard = true; };
  for (const Tick end = bus_.now() + timeout; !heard && bus_.now() < end && !bus_.tripped();) {
    port_.send(kAskStatus);
    for (const Tick again = bus_.now() + kStartAgain; !heard && bus_.now() < again;) port_.run_until(again);
  }
  while (heard && port_.run_until(bus_.now() + kQuiet)) {}
  port_.on_character = [this](std::uint8_t c) { received(c); };
  return heard;
}

// ---------------------------------------------------------------------------------------------------------------- jobs

void ControllerDialogue::begin(std::deque<Item> items) {
  items_ = std::move(items);
  result_ = {};
  last_ = bus_.now();
  sent_ = 0;
}

void ControllerDialogue::begin_lines(const std::vector<std::string>& lines, bool stop_at_error) {
  std::deque<Item> items;
  for (const std::string& line : lines) {
    Item item;
    for (const char c : line.substr(line.rfind(kClearInput) + 1)) {  // what is before ^X is void
      if (is_answered_control(static_cast<std::uint8_t>(c)))
        items.push_back({std::string(1, c), true});
      else
        item.bytes.push_back(c);
    }
    items.push_back(item);
  }
  begin(std::move(items));
  stop_at_error_ = stop_at_error;
  clear_wait_ = kClearWait;
  if (owes_)
    phase_ = Phase::kClear;
  else
    next_item();
}

void ControllerDialogue::begin_control(std::uint8_t c) {
  begin({{std::string(1, static_cast<char>(c)), true}});
  clear_wait_ = kClearWait;
  if (owes_)
    phase_ = Phase::kClear;
  else
    next_item();
}

void ControllerDialogue::begin_clear(Tick wait) {
  begin({});
  clear_wait_ = wait;
  phase_ = Phase::kClear;
}

void ControllerDialogue::abandon() {
  if (phase_ == Phase::kNone) return;
  owes_ = result_.lost = true;
  items_.clear();
  phase_ = Phase::kNone;
  mark_ = Mark::kNone;
  changed_ = true;
}

void ControllerDialogue::next_item() {
  sent_ = 0;
  heard_ = false;
  phase_ = items_.empty() ? Phase::kNone : Phase::kSend;
  changed_ = true;
  if (!items_.empty()) answer_ = ControllerAnswer(checksum(), had_sums_);
}

std::uint8_t ControllerDialogue::checksum() const {
  const Item& item = items_.front();
  return item.control ? static_cast<std::uint8_t>(item.bytes[0]) : command_checksum(item.bytes);
}

// ---------------------------------------------------------------------------------------------------------- characters

void ControllerDialogue::put_next() {
  if (!port_.idle()) return;
  if (!urgent_.empty() && !inside_line()) {
    port_.send(urgent_.front());
    urgent_.pop_front();
  } else if (phase_ == Phase::kClear) {
    if (sent_++ == 0) port_.send(static_cast<std::uint8_t>(kClearInput));
  } else if (phase_ == Phase::kSend) {
    const Item& item = items_.front();
    const std::size_t length = item.bytes.size() + (item.control ? 0 : 1);
    port_.send(sent_ < item.bytes.size() ? static_cast<std::uint8_t>(item.bytes[sent_]) : '\r');
    if (++sent_ < length) return;
    phase_ = Phase::kAnswer;
    asked_ = bus_.now();
  } else if (mark_ == Mark::kWanted) {
    port_.send(kAskMark);
    mark_ = Mark::kSent;
  }
}

bool ControllerDialogue::step(Tick limit) {
  changed_ = false;
  if (busy() && bus_.tripped()) {
    abandon();
    return true;
  }
  if (phase_ == Phase::kAnswer && bus_.now() >= asked_ + kLongestAnswer) {
    answer_.quiet();
    say(answer_.release());
    abandon();
    return true;
  }
  put_next();
  // What has come while the bus was busy with something else is looked at before patience ends.
  const Tick end = busy() ? std::max(last_ + patience(), bus_.now() + 1) : limit;
  const bool mark_goes = mark_ == Mark::kSent && !port_.idle();
  if (port_.run_until(std::min(limit, end))) {
    if (!mark_goes || !port_.idle()) last_ = bus_.now();  // a question is no sign of life
  } else if (busy() && bus_.now() >= end)
    out_of_patience();
  return changed_;
}

// What an answer begins with is a character of text, CR or LF, or one that stands for something.
bool ControllerDialogue::may_begin_answer(std::uint8_t c) const {
  constexpr std::string_view kOthers("\x02\x06\x07\r\n\0", 6);
  const char text = static_cast<char>(c);
  return is_binary() || (c >= ' ' && c < 0x7F) || kOthers.find(text) != std::string_view::npos;
}

// A mark, an echo or a checksum that comes when nobody waits for it any more. The next line may have been sent already,
// where it is a CR alone.
bool ControllerDialogue::is_stray(std::uint8_t c) {
  if (late_mark_ && c == kMark) {
    late_mark_ = false;
    return true;
  }
  const std::optional<std::uint8_t> sum = late_sum_;
  late_sum_.reset();
  if (phase_ == Phase::kAnswer && (!answer_.empty() || may_begin_answer(c))) return false;
  if (sum && c == *sum) {
    had_sums_ = true;
    return true;
  }
  return phase_ != Phase::kAnswer && static_cast<char>(c) == kClearInput;
}

void ControllerDialogue::received(std::uint8_t c) {
  if (phase_ == Phase::kClear) {
    if (static_cast<char>(c) != kClearInput || sent_ == 0) return;
    owes_ = late_mark_ = false;
    return next_item();
  }
  if (is_stray(c)) return;
  if (phase_ != Phase::kAnswer) {  // nobody has asked for it
    const char text = static_cast<char>(c);
    return say(std::string_view(&text, 1));
  }
  if (is_binary()) {
    heard_ = true;
    const char byte = static_cast<char>(c);
    return say(std::string_view(&byte, 1));
  }
  if (mark_ == Mark::kSeen) {  // it was a checksum
    answer_.take(kMark);
    mark_ = Mark::kSent;
  }
  if (mark_ == Mark::kSent && c == kMark)
    mark_ = Mark::kSeen;
  else
    answer_.take(c);
  say(answer_.release());
  if (answer_.ended()) end_item();
}

void ControllerDialogue::say(std::string_view text) {
  if (text.empty()) return;
  changed_ = true;
  on_text(text);
}

// Any byte of its answer may be what ends others, so silence alone ends it (firmware:5.9/5).
bool ControllerDialogue::is_binary() const {
  return !items_.empty() && items_.front().control && items_.front().bytes[0] == kSources;
}

bool ControllerDialogue::may_have_ended() const {
  return phase_ == Phase::kAnswer &&
         (heard_ || mark_ == Mark::kSeen || answer_.may_have_ended() || (items_.front().control && !answer_.empty()));
}

bool ControllerDialogue::wants_mark() const {
  return phase_ == Phase::kAnswer && mark_ == Mark::kNone && !items_.front().control;
}

Tick ControllerDialogue::patience() const {
  if (phase_ == Phase::kClear) return clear_wait_;
  if (may_have_ended()) return mark_ == Mark::kSeen ? kMarkQuiet : kQuiet;
  if (wants_mark()) return unacknowledged_ ? 0 : kQuiet;
  return may_take_long(items_.front().bytes) ? kSavePatience : kPatience;
}

void ControllerDialogue::out_of_patience() {
  if (phase_ == Phase::kClear) {
    owes_ = late_mark_ = false;
    return next_item();
  }
  const bool lost = !may_have_ended();
  if (lost && wants_mark()) {
    mark_ = Mark::kWanted;
    return;
  }
  answer_.quiet();
  say(answer_.release());
  if (lost) return abandon();
  end_item();
}

void ControllerDialogue::end_item() {
  const bool by_mark = mark_ == Mark::kSeen;
  if (!answer_.error()) unacknowledged_ = by_mark;
  late_mark_ = mark_ == Mark::kSent;
  mark_ = Mark::kNone;
  if (!is_binary()) {
    had_sums_ = answer_.had_sums();
    if (!had_sums_ && !answer_.error() && !by_mark) late_sum_ = checksum();
  }
  if (!items_.front().control) ++result_.lines;
  result_.error = answer_.error();
  result_.error_number = answer_.error_number();
  items_.pop_front();
  last_ = bus_.now();
  if (result_.error && stop_at_error_) items_.clear();
  next_item();
}

}  // namespace brick
