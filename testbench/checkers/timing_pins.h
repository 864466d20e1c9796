// A cycle of Port A as the lines showed it: made from the levels and their times alone (systemc/cpu/port_a_watch.h),
// whoever drove them. It begins with the fall of a strobe and is complete when the address, and in a write the data,
// have gone.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "systemc/cpu/port_a_watch.h"

namespace brick {

struct PinCycle {
  std::uint32_t address = 0;
  bool x = false;
  std::uint8_t aa = 0;
  bool write = false;
  std::uint32_t data = 0;  // what stood on D as the strobe rose
  std::uint32_t pc = 0;
  unsigned multiplier = 8, wait_states = 0;
  unsigned stretched = 0;  // clocks by which the strobe was longer than programmed
  unsigned asked = 0;      // clocks for which /TA surely asked

  TimeFs start = 0;  // last move of address and AA before the strobe fell
  TimeFs strobe_low = 0, strobe_high = 0;
  TimeFs end = 0;              // first move of address and AA after it had fallen
  bool both_strobes = false;   // the other one was low too
  bool address_moved = false;  // while the strobe was low

  TimeFs data_on = 0;           // write: the CPU drives D
  TimeFs data_off = 0;          // write: and no longer
  TimeFs data_valid = 0;        // last change of D up to the end of the strobe; the strobe's end if nobody drove D
  TimeFs data_held = 0;         // first change from the end of the strobe on, the end of the cycle if there was none
  bool data_lost = false;       // read: let go before /RD rose, at data_held
  bool drives_outside = false;  // since the cycle before the board drove D with /RD high
  bool corrupted = false;       // read: D moved, or nobody drove it, in the last 5 ns of /RD

  TimeFs ta_moved = 0;                  // last change of /TA up to the end of the strobe, the start if there was none
  TimeFs ta_held = 0;                   // first change from there on, the end of the cycle if there was none
  bool ta_high = false;                 // the device still said "not yet" as the strobe rose
  unsigned ta_seen = 0, ta_missed = 0;  // it moved from a sample to the end of the strobe and was taken after, before

  // From the end of one side's driving D to the beginning of the other's, below zero where both drove it.
  std::optional<TimeFs> turnaround;
  bool cpu_followed = false;  // the CPU began later
};

class PinWatch final : public PortAWatch {
 public:
  std::function<void(const PinCycle&)> on_cycle;

  // The board lets go of D with /RD, which comes to it so late (--skew).
  void set_pin_delay(TimeFs delay) { pin_delay_ = delay; }

  void cpu_moved(TimeFs time, const PortALevels& levels) override;
  void board_moved(TimeFs time, const BoardOutputs& board) override;
  void bus_reset() override;

 private:
  enum class State { kIdle, kLow, kHigh };  // of the cycle's strobe
  struct Board {                            // what the board shows from `time` on
    TimeFs time = 0;
    std::uint32_t data = 0;
    bool driven = false, busy = false;
  };
  struct Driving {  // D by one side, the last time
    bool ever = false, now = false;
    TimeFs on = 0, off = 0;
    void set(bool drives, TimeFs time) {
      if (drives == now) return;
      now = drives;
      ever = true;
      (drives ? on : off) = time;
    }
    TimeFs end(TimeFs time) const { return now ? time : off; }
  };

  void begin(TimeFs time);
  void strobe_ended(TimeFs time);
  void finish(TimeFs time);
  void read_data();
  void acknowledge();
  void turnaround(TimeFs time);
  std::size_t seen_at(TimeFs time) const;

  State state_ = State::kIdle;
  PinCycle cycle_;
  bool ended_ = false, data_moved_ = false;  // since the strobe fell; since it rose
  PortALevels cpu_;
  TimeFs address_time_ = 0, data_time_ = 0;   // of their last moves
  static constexpr TimeFs kReset = kForever;  // lets go of D without /RD
  TimeFs rd_high_ = kReset, pin_delay_ = 0;
  bool drives_outside_ = false;
  Driving cpu_drives_, board_drives_;
  std::vector<Board> seen_{1};  // since the address came, oldest first
  std::size_t seen_high_ = 0;   // how many of them until the strobe rose
};

}  // namespace brick
