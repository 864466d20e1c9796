// The time base. A tick is one period of clk_pwm (117.9648 MHz): 78125/9216 ns, not a whole number of femtoseconds.
// All clocked hardware keeps time as an integer tick count; edges of the CPU bus and of the host bus, which run on
// other clocks, are kept in femtoseconds. Conversion is exact integer arithmetic, so nothing drifts.
// "Now is tick t" means: the clock edges numbered 1..t have happened.
#pragma once

#include <cstdint>

namespace brick {

using Tick = std::int64_t;    // periods of clk_pwm since power-on
using TimeFs = std::int64_t;  // femtoseconds since power-on (2.5 hours at most)

constexpr std::int64_t kPwmClockHz = 117'964'800;  // servo-ic:3
constexpr Tick kTicksPerRef = 3;                   // clk_ref (39.3216 MHz) rises on every third tick
constexpr Tick kNever = INT64_MAX / 4;

namespace detail {
// 144 ticks are exactly this many femtoseconds; working in such blocks keeps every product below in 64 bits.
constexpr TimeFs kBlockFs = 1'220'703'125;
constexpr Tick kBlockTicks = 144;
}  // namespace detail

// Time of clock edge `t` in femtoseconds, rounded down (less than 1 fs early; the functions below allow for it).
constexpr TimeFs tick_to_fs(Tick t) {
  return t / detail::kBlockTicks * detail::kBlockFs + t % detail::kBlockTicks * detail::kBlockFs / detail::kBlockTicks;
}

// First tick whose clock edge is not before `time`: an input that changes at `time` is seen by this edge.
constexpr Tick fs_to_tick(TimeFs time) {
  const TimeFs rest = time % detail::kBlockFs;
  return time / detail::kBlockFs * detail::kBlockTicks +
         (rest * detail::kBlockTicks + detail::kBlockFs - 1) / detail::kBlockFs;
}

// Last tick whose clock edge is not after `time`: an output sampled at `time` shows the state after this edge.
constexpr Tick fs_to_tick_floor(TimeFs time) {
  const TimeFs rest = time % detail::kBlockFs;
  return time / detail::kBlockFs * detail::kBlockTicks + ((rest + 1) * detail::kBlockTicks - 1) / detail::kBlockFs;
}

constexpr TimeFs kFsPerNs = 1'000'000;
constexpr Tick ns_to_ticks(std::int64_t ns) { return fs_to_tick(ns * kFsPerNs); }

}  // namespace brick
