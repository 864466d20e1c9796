// Model of rtl/servo_ic/channel_decode.sv: what one SCLK edge makes of the filtered inputs A, B, C and of the PFM
// pulse.
#pragma once

#include <array>
#include <cstdint>

#include "rtl/regs/brick_regs.hpp"

namespace brick {

// A before B counts up in the clockwise modes.
constexpr bool kALeadsUp = true;

template <bool ALeadsUp>
class BasicChannelDecode {
 public:
  struct Result {
    bool count = false, down = false;  // the counter moves
    bool error = false;                // illegal transition
    bool mark = false, echo = false;   // MLDT: excitation, echo
  };

  // `abc`: bit 0 A, 1 B, 2 C. Also remembers them for the next edge.
  Result step(bool ready, std::uint32_t mode, bool hold, unsigned abc, bool pulse, bool pulse_down) {
    const unsigned last = last_;
    last_ = abc;
    Result r;
    const bool a_rises = (abc & 1) != 0 && (last & 1) == 0;
    const unsigned moved = (position(abc) - position(last)) & 3;
    const bool ccw = (mode & kCounterClockwise) != 0;
    r.down = (moved == (ALeadsUp ? 3u : 1u)) != ccw;
    switch (mode) {
      case regs::decode::kPulseCw:
      case regs::decode::kPulseCcw:
        r.count = a_rises;
        r.down = ((abc & 2) == 0) != ccw;
        break;
      case regs::decode::kX1Cw:
      case regs::decode::kX1Ccw:
        r.count = (moved & 1) != 0 && ((abc | last) & 2) == 0;
        r.error = moved == 2;
        break;
      case regs::decode::kX2Cw:
      case regs::decode::kX2Ccw:
        r.count = (moved & 1) != 0 && ((abc ^ last) & 1) != 0;
        r.error = moved == 2;
        break;
      case regs::decode::kX4Cw:
      case regs::decode::kX4Ccw:
        r.count = (moved & 1) != 0;
        r.error = moved == 2;
        break;
      case regs::decode::kInternalPulse:
        r.count = pulse;
        r.down = pulse_down;
        break;
      case regs::decode::kHallCw:
      case regs::decode::kHallCcw:
        hall(abc, last, ccw, r);
        break;
      case regs::decode::kMldt:
        r.mark = ready && pulse;
        r.echo = ready && a_rises;
        break;
      default:
        break;
    }
    r.count = r.count && ready && !hold;
    r.error = r.error && ready;
    return r;
  }

 private:
  // The two codes of a mode differ in this bit.
  static constexpr std::uint32_t kCounterClockwise = regs::decode::kX4Cw ^ regs::decode::kX4Ccw;

  // Place in the cycle 00, 10, 11, 01 of {A, B}.
  static unsigned position(unsigned abc) { return (abc & 2) | ((abc ^ abc >> 1) & 1); }

  static void hall(unsigned abc, unsigned last, bool ccw, Result& r) {
    // Place in the cycle 001, 011, 010, 110, 100, 101 of {A, B, C}, by {C, B, A}.
    constexpr int kNone = -1;
    constexpr std::array<int, 8> kPlace{kNone, 4, 2, 3, 0, 5, 1, kNone};
    const int now = kPlace[abc], before = kPlace[last];
    r.error = now == kNone;
    if (now == kNone || before == kNone || now == before) return;
    const bool up = now == (before + 1) % 6, down = before == (now + 1) % 6;
    r.count = up || down;
    r.down = down != ccw;
    r.error = !r.count;
  }

  unsigned last_ = 0;
};
using ChannelDecode = BasicChannelDecode<kALeadsUp>;

}  // namespace brick
