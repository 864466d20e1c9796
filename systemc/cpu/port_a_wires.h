// The wires between the CPU and the board: which edge of the board's clock is the first to see a line of Port A move.
// Without aperture and skew it is the first that is not before the move. With --aperture a line that moves near an edge
// is taken early or late (systemc/core/aperture.h); with --skew each line has a delay of its own. What they do is
// decided here, from times and the seed alone, so that every engine gets the same pins.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "systemc/core/aperture.h"
#include "systemc/core/board_pins.h"

namespace brick {

// All lines in one word: bit 0 up A, then X, AA, the on-chip select, /RD, /WR, D.
using PortALineBits = std::uint64_t;
constexpr unsigned kPortALines = 51;
constexpr unsigned kAaLine = 20, kIntLine = 24, kRdLine = 25, kWrLine = 26;
PortALineBits port_a_lines(const PortAPins& pins);
void set_port_a_lines(PortAPins& pins, PortALineBits lines);

// Delays of the board's input pads and the wires to them, drawn once, the same for both edges of a line. Each is
// anything from 0 to a period of clk_pwm, and one of the two ends as often as not: the ends are the worst.
class PinSkew {
 public:
  static constexpr TimeFs kMost = detail::kBlockFs / detail::kBlockTicks;  // 8.477 ns
  static constexpr TimeFs kOutput = 10 * kFsPerNs;  // from the board's clock to D and /TA at the CPU

  PinSkew() = default;  // none
  explicit PinSkew(std::uint64_t seed);
  bool on() const { return on_; }
  TimeFs of(unsigned line) const { return delay_[line]; }
  TimeFs of_strobe(bool write) const { return delay_[write ? kWrLine : kRdLine]; }
  void set(unsigned line, TimeFs delay) { on_ = true, delay_[line] = delay; }

 private:
  bool on_ = false;
  std::array<TimeFs, kPortALines> delay_{};
};

class PortAWires {
 public:
  void set_aperture(Aperture* aperture) { aperture_ = aperture; }  // not owned
  void set_skew(const PinSkew& skew) { skew_ = skew; }
  const PinSkew& skew() const { return skew_; }
  bool plain() const { return !skew_.on() && (aperture_ == nullptr || !aperture_->on()); }

  // The first edge that may see a move at `time`, and the one that sees this line move then.
  Tick first(TimeFs time) const { return aperture_ != nullptr ? aperture_->first(time) : fs_to_tick(time); }
  Tick seen(unsigned line, TimeFs time) const;

  // The CPU moves its lines at `time`; the board stands at `now`.
  void move(TimeFs time, const PortAPins& from, const PortAPins& to, Tick now);
  // The board must stand there for the next of these moves; kNever: none is under way.
  Tick next() const { return moves_.empty() ? kNever : moves_.front().stand; }
  // Where it must stand so that it has followed what moves without a clock up to `time`; 0: anywhere.
  Tick followed_until(TimeFs time) const;
  struct Taken {
    TimeFs time;   // at which the lines move at the board
    bool follows;  // the board follows them without a clock
  };
  Taken take(PortAPins& pins);
  void forget() { moves_.clear(); }

 private:
  struct Move {
    Tick stand;
    TimeFs time;
    PortALineBits lines, levels;
  };

  PortALineBits followed() const;

  Aperture* aperture_ = nullptr;
  PinSkew skew_;
  std::vector<Move> moves_;  // next first
};

}  // namespace brick
