// Talks to the controller as host software does: sends command lines through the host port, collects replies,
// understands the framing of I3, I4 and I6 (firmware:6) and follows it when a line, a program or a restart changes it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "testbench/host/framing_probe.h"
#include "testbench/host/host_bus.h"
#include "testbench/host/reply_parser.h"

namespace brick {

class HostLink {
 public:
  static constexpr Tick kBootTime = ns_to_ticks(500'000'000);  // longest wait for the firmware after power-on or reset
  static constexpr Tick kReplyTime = ns_to_ticks(1'000'000'000);  // longest wait for an answer
  static constexpr Tick kSaveTime = ns_to_ticks(10'000'000'000);  // SAVE takes seconds
  static constexpr Tick kQuietTime = ns_to_ticks(5'000'000);      // I3 = 0 and 1: nothing for so long means the end
  static constexpr Tick kRestless = ns_to_ticks(20'000'000);      // never quiet for so long: programs send all the time
  static constexpr std::size_t kLongestReply = 1 << 20;           // bytes; no reply is longer than that

  explicit HostLink(HostBus& bus) : bus_(bus) {}

  // Waits for the firmware and selects I3=2, I6=1, I4=0 as host programs do. False when nothing answers within
  // `timeout`.
  bool connect(Tick timeout);

  // Sends `line` and CR, returns the reply. Control characters may be inside. `timeout`: from one character to the
  // next. A line that restarts the controller ($$$, $$$*** anywhere in it) connects again. What I3 and I4 are is looked
  // at after a line that may change them or has control characters, where no end of the reply shows (I3 = 0, or a reply
  // that does not end), and where checksums came that were not expected, or wrong ones: a program may change them too.
  // The answer to that also ends a reply where programs send texts all the time.
  Reply command(const std::string& line);
  Reply command(const std::string& line, Tick timeout);

  // Sends one control character without CR. Nobody knows whether it is answered: that is asked after it.
  Reply control(std::uint8_t c);

  // Sends `line` and CR and returns at once; finish() collects the reply. `send` is false when the port takes no
  // character.
  bool send(const std::string& line, Tick timeout = kReplyTime);
  Reply finish(Tick timeout = kReplyTime);

  // Lines that came without being asked for (SEND, CMD in programs) since the last call.
  std::vector<std::string> take_unsolicited();
  void poll();  // reads what waits in the host port

  HostBus& bus() { return bus_; }
  const Framing& framing() const { return framing_; }

 private:
  using Checksum = std::optional<std::uint8_t>;  // of the line that is answered; none: any byte will do

  bool put(std::uint8_t c, Tick deadline);
  bool receive(Tick deadline);  // one byte into incoming_
  void keep(std::uint8_t c);
  void poll_to_end_of_text();
  void take_stray();
  Checksum sum_of_sent() const;
  ReplyParser collect(ReplyParser parser, Tick timeout);
  Reply parsed(const std::string& bytes, Checksum command, const Framing& before, bool mixed) const;
  Reply taken(Reply reply, const std::string& bytes);  // what of `bytes` is none of it stays in incoming_
  Reply asked(Checksum command, bool mixed, Tick timeout, std::size_t own);
  Reply confirmed(const ReplyParser& parser, Checksum command);
  Reply restarted();
  void conclude(const Reply& reply, Checksum command);
  void look_for_late_checksum();
  std::optional<std::string> ask_framing(Tick timeout, std::size_t begin, std::size_t own = 0);
  bool read_answer();
  std::string take_answer(const std::vector<FramingAnswer>& answers);
  bool try_connect(Tick deadline);

  HostBus& bus_;
  Framing framing_{2, 0};  // as connect() selects it
  std::string incoming_;   // received while sending, not yet looked at
  Tick received_ = 0;      // when the last of it was
  std::string stray_;      // begun line of unsolicited text
  std::vector<std::string> unsolicited_;
  std::string sent_;           // line that finish() waits for, or that was the last
  unsigned unanswered_ = 0;    // ^B
  std::string doubt_;          // why its answers say nothing
  bool acknowledged_ = false;  // the last line was, without a checksum
  Checksum acknowledged_sum_;  // which would have been this one
};

}  // namespace brick
