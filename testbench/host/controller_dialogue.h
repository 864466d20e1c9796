// Lines and control characters through the host port, one job after the other, for the communications processor: what a
// job is answered, when it has ended, and what the controller says of itself in between.
#pragma once

#include <algorithm>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "testbench/host/controller_answer.h"
#include "testbench/host/interrupt_port.h"

namespace brick {

bool is_report_control(std::uint8_t c);    // ^B ^C ^F ^G ^P ^V
bool is_answered_control(std::uint8_t c);  // these, and those that are answered with a line or a byte

class ControllerDialogue {
 public:
  static constexpr Tick kPatience = ns_to_ticks(500'000'000);          // without an answer
  static constexpr Tick kSavePatience = ns_to_ticks(10'000'000'000);   // of a line that SAVEs
  static constexpr Tick kLongestAnswer = ns_to_ticks(30'000'000'000);  // then it is what programs say, without an end
  static constexpr Tick kQuiet = ns_to_ticks(5'000'000);  // nothing for so long ends an answer that may have ended

  explicit ControllerDialogue(HostBus& bus);

  // Waits for the firmware after power-on; false when nothing answers within `timeout`.
  bool start(Tick timeout);

  // A job; only when there is none.
  // Each line without its CR. Control characters that are answered by themselves are jobs of their own before it.
  void begin_lines(const std::vector<std::string>& lines, bool stop_at_error);
  void begin_control(std::uint8_t c);
  void begin_clear(Tick wait);  // ^X, and its echo or `wait`
  void abandon();               // what is still to come is cleared away before the next job
  bool busy() const { return phase_ != Phase::kNone; }
  bool has_lines_to_send() const { return items_.size() > (phase_ == Phase::kAnswer || inside_line() ? 1 : 0); }

  // Whatever job there is, but not inside a line; once for all requests that come before it is sent.
  void send_at_once(std::uint8_t c) {
    if (std::find(urgent_.begin(), urgent_.end(), c) == urgent_.end()) urgent_.push_back(c);
  }
  bool sends_at_once() const { return !urgent_.empty(); }

  // To the next character or the end of a job, at most to tick `limit`. True when there is text, or a job has ended.
  bool step(Tick limit);
  std::function<void(std::string_view)> on_text;

  // How the last job ended.
  struct Result {
    std::size_t lines = 0;  // that were answered
    bool lost = false;      // the next of them was not
    bool error = false;     // the last of them was refused
    unsigned error_number = 0;
  };
  const Result& result() const { return result_; }

  InterruptPort& port() { return port_; }

 private:
  enum class Phase { kNone, kClear, kSend, kAnswer };
  // ^N behind a line that nothing acknowledges (I3 = 0). Its answer is a lone NUL, whatever I3 and I4 are, and comes
  // when the line has been carried out. No other NUL is ever sent but as a checksum, behind which more follows.
  enum class Mark { kNone, kWanted, kSent, kSeen };
  struct Item {
    std::string bytes;
    bool control = false;  // a character by itself
  };

  bool inside_line() const { return phase_ == Phase::kSend && sent_ > 0; }
  void begin(std::deque<Item> items);
  void next_item();
  std::uint8_t checksum() const;  // of the first item
  void put_next();
  void received(std::uint8_t c);
  bool may_begin_answer(std::uint8_t c) const;
  bool is_stray(std::uint8_t c);
  bool is_binary() const;  // the answer to the first item is
  bool may_have_ended() const;
  bool wants_mark() const;
  void say(std::string_view text);
  Tick patience() const;
  void out_of_patience();
  void end_item();

  HostBus& bus_;
  InterruptPort port_;
  std::deque<std::uint8_t> urgent_;
  Phase phase_ = Phase::kNone;
  std::deque<Item> items_;  // of the job, the first as far as sent_
  std::size_t sent_ = 0;
  ControllerAnswer answer_;
  Result result_;
  bool stop_at_error_ = false;
  bool changed_ = false;
  Tick clear_wait_ = 0, last_ = 0;  // when the last character came or went
  Tick asked_ = 0;                  // when the first item had been sent
  bool owes_ = false;               // the controller may still answer an earlier job
  bool had_sums_ = false;
  bool heard_ = false;  // something of a binary answer
  Mark mark_ = Mark::kNone;
  bool late_mark_ = false;                // the item before has ended, its mark is still to come
  bool unacknowledged_ = false;           // the item before was; this one will be, too
  std::optional<std::uint8_t> late_sum_;  // would follow an acknowledge that seemed to be the end
};

}  // namespace brick
