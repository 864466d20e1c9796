// Model of rtl/servo_ic/channel_compare.sv: position compare with auto-increment, in counts or, with hardware 1/T, in
// 1/4096 count.
#pragma once

#include <algorithm>
#include <cstdint>

#include "rtl/regs/brick_regs.hpp"

namespace brick {

// Position of a channel as a compare sees it before an SCLK edge, and what that edge does to it.
struct ChannelPosition {
  std::uint32_t counter = 0;
  unsigned fraction = 0;
  bool still = false;  // what it does here is no motion
  bool count = false, down = false;
};

// EQU toggles when the counter leaves equality, or when it arrives there.
constexpr bool kEquOnLeave = true;

template <bool EquOnLeave>
class BasicChannelCompare {
 public:
  std::uint32_t a() const { return a_; }
  std::uint32_t b() const { return b_; }
  std::uint32_t inc() const { return inc_; }
  unsigned a_fraction() const { return af_; }
  unsigned b_fraction() const { return bf_; }
  bool equ() const { return equ_; }
  void set_a(std::uint32_t v) { a_ = v; }
  void set_b(std::uint32_t v) { b_ = v; }
  void set_inc(std::uint32_t v) { inc_ = v; }
  void set_a_fraction(std::uint32_t v) { af_ = regs::servo_channel_fine::timer2::kCompareA.get(v); }
  void set_b_fraction(std::uint32_t v) { bf_ = regs::servo_channel_fine::timer1::kCompareB.get(v); }
  void set_equ(bool v) { equ_ = v; }

  // What the position has done since the last SCLK edge is no motion.
  void forget() { known_ = false; }

  void sclk(const ChannelPosition& p, bool fine) {
    bool hit_a = false, hit_b = false, down = p.down;
    const std::uint64_t pos = std::uint64_t{p.counter} << 12 | p.fraction;
    if (!fine) {
      const std::uint32_t at = EquOnLeave ? p.counter : (p.counter + (p.down ? 0xFFFFFF : 1)) & 0xFFFFFF;
      hit_a = p.count && at == a_;
      hit_b = p.count && at == b_;
    } else if (known_ && !p.still) {
      down = ((pos - last_) >> 35 & 1) != 0;
      hit_a = passed(pos, std::uint64_t{a_} << 12 | af_, down);
      hit_b = passed(pos, std::uint64_t{b_} << 12 | bf_, down);
    }
    const std::uint32_t step = down ? 0 - inc_ : inc_;
    if (hit_b) a_ = (a_ + step) & 0xFFFFFF;
    if (hit_a) b_ = (b_ + step) & 0xFFFFFF;
    equ_ ^= hit_a != hit_b;
    last_ = pos;
    known_ = fine && !p.still;
  }

  // The counter moves one count an SCLK edge at most, so EQU stays for so many of them after one that showed `counter`:
  // to leave a compare takes one count more than to arrive there.
  std::uint32_t edges_to_hit(std::uint32_t counter, bool fine) const {
    const auto distance = [counter](std::uint32_t at) {
      return std::min((at - counter) & 0xFFFFFF, (counter - at) & 0xFFFFFF);
    };
    const std::uint32_t counts = std::min(distance(a_), distance(b_));
    const std::uint32_t early = (fine ? 3u : 0u) + (EquOnLeave ? 0u : 1u);
    return counts - std::min(counts, early);
  }

 private:
  // Not beyond `at` at the last edge, and beyond it now; arriving, before it at the last edge, and not any more.
  bool passed(std::uint64_t pos, std::uint64_t at, bool down) const {
    constexpr std::uint64_t kMask = (std::uint64_t{1} << 36) - 1;
    const std::uint64_t ahead = (down ? last_ - at : at - last_) & kMask,
                        way = (down ? last_ - pos : pos - last_) & kMask;
    return EquOnLeave ? ahead < way : ahead != 0 && ahead <= way;
  }

  std::uint32_t a_ = 0, b_ = 0, inc_ = 0;
  unsigned af_ = 0, bf_ = 0;
  std::uint64_t last_ = 0;
  bool equ_ = false, known_ = false;
};
using ChannelCompare = BasicChannelCompare<kEquOnLeave>;

}  // namespace brick
