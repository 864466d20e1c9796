// The time base. A tick is one period of clk_pwm (117.9648 MHz): 78125/9216 ns, not a whole number of femtoseconds.
// All clocked hardware keeps time as an integer tick count; edges of the CPU bus and of the host bus, which run on
// other clocks, are kept in femtoseconds. Conversion is exact integer arithmetic, so nothing drifts.
// "Now is tick t" means: the clock edges numbered 1..t have happened.
#pragma once

#include <cstdint>

namespace brick {

using Tick = std::int64_t;  // periods of clk_pwm since power-on: 2,400 years
using TimeFs = __int128;    // femtoseconds, since power-on or between two instants; 64 bits would end after 2.5 hours

constexpr std::int64_t kPwmClockHz = 117'964'800;  // servo-ic:3
constexpr Tick kTicksPerRef = 3;                   // clk_ref (39.3216 MHz) rises on every third tick
constexpr Tick kNever = INT64_MAX / 4;

namespace detail {
// 144 ticks are exactly this many femtoseconds; working in such blocks keeps every product below in 64 bits.
constexpr std::int64_t kBlockFs = 1'220'703'125;
constexpr Tick kBlockTicks = 144;

// A time as whole blocks and what is left of the next one, 0 to kBlockFs - 1. By the reciprocal, because this is done
// for every bus cycle and a division of 128 bits costs ten times as much: the quotient is at most two less than the
// true one, for times up to 2^93 fs.
struct Blocks {
  std::int64_t whole, rest;
};
constexpr Blocks blocks(TimeFs time) {
  constexpr int kShift = 30, kScale = 63;
  constexpr auto kReciprocal = static_cast<std::int64_t>((TimeFs{1} << (kShift + kScale)) / kBlockFs);
  const auto high = static_cast<std::int64_t>(time >> kShift);
  auto whole = static_cast<std::int64_t>(static_cast<TimeFs>(high) * kReciprocal >> kScale);
  auto rest =
      static_cast<std::int64_t>(static_cast<std::uint64_t>(time) - static_cast<std::uint64_t>(whole) * kBlockFs);
  for (; rest >= kBlockFs; rest -= kBlockFs) ++whole;
  for (; rest < 0; rest += kBlockFs) --whole;  // of a time before power-on
  return {whole, rest};
}
}  // namespace detail

// Time of clock edge `t` in femtoseconds, rounded down (less than 1 fs early; the functions below allow for it).
constexpr TimeFs tick_to_fs(Tick t) {
  return static_cast<TimeFs>(t / detail::kBlockTicks) * detail::kBlockFs +
         t % detail::kBlockTicks * detail::kBlockFs / detail::kBlockTicks;
}

// First tick whose clock edge is not before `time`: an input that changes at `time` is seen by this edge.
constexpr Tick fs_to_tick(TimeFs time) {
  const auto [whole, rest] = detail::blocks(time);
  return whole * detail::kBlockTicks + (rest * detail::kBlockTicks + detail::kBlockFs - 1) / detail::kBlockFs;
}

// Last tick whose clock edge is not after `time`: an output sampled at `time` shows the state after this edge.
constexpr Tick fs_to_tick_floor(TimeFs time) {
  const auto [whole, rest] = detail::blocks(time);
  return whole * detail::kBlockTicks + ((rest + 1) * detail::kBlockTicks - 1) / detail::kBlockFs;
}

constexpr TimeFs kForever = tick_to_fs(INT64_MAX);  // the last edge there is a number for: beyond it none converts
static_assert(fs_to_tick(kForever) == INT64_MAX && fs_to_tick_floor(kForever) == INT64_MAX);

constexpr TimeFs kFsPerNs = 1'000'000;
constexpr Tick ns_to_ticks(std::int64_t ns) { return fs_to_tick(ns * kFsPerNs); }

// As a number of 64 bits, for what can say no more: nanoseconds are good for 292 years.
constexpr std::int64_t fs_to_ns(TimeFs time) { return static_cast<std::int64_t>(time / kFsPerNs); }

}  // namespace brick
