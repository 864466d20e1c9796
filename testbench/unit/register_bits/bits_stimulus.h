// Stimuli that several rows of the bit table share: a fast triangle, one PFM pulse, a serial word off the pins.
#pragma once

#include "testbench/unit/register_bits/bits_rig.h"

namespace brick {

constexpr unsigned kDacClkPin = 1, kDacStrobePin = 2, kAdcClkPin = 4, kAdcStrobePin = 8;  // of ChannelPins::serial

// Puts a new PWM word to use without waiting for two half periods of the reset value 6527: the fourth rising edge of
// PHASE in a row that comes at a wrong time forces a turnaround, and a new maximum count is taken at the bottom one.
inline void start_triangle(BitsRig& rig, std::uint32_t pwm_word) {
  rig.start();
  rig.write(ic_words::kPwmControl, pwm_word);
  const auto edges = [&](int n) {
    while (n-- > 0) rig.latch();
  };
  edges(4);  // to the top
  rig.run(6540);
  edges(4);  // to the bottom
  edges(1);  // from there into the new range
}

// The accumulator starts at 0, so -1 underflows at once. Returns the width of the pulse, or `limit`.
inline Tick pfm_pulse(BitsRig& rig, unsigned channel, Tick limit) {
  rig.write(channel, words::kControl, kPfm);
  rig.write(channel, words::kOutC, 0xFFFFFF);
  if (rig.until(limit, [&] { return rig.other(kPulse, channel); }) == limit) return limit;
  const Tick rise = rig.now();
  rig.write(channel, words::kOutC, 0);
  rig.until(limit, [&] { return !rig.other(kPulse, channel); });
  return rig.now() - rise;
}

// Levels of a pin at the rising edges of a serial clock after PHASE rises, first one in bit 23; 0xFFFFFFFF if there are
// not 24.
template <class Level>
std::uint32_t receive(BitsRig& rig, unsigned clock, Level level) {
  rig.in.phase = false;
  rig.run(100);
  rig.in.phase = true;
  std::uint32_t word = 0;
  int edges = 0;
  bool last = false;
  for (int t = 0; t < 100; ++t) {
    rig.tick();
    const bool now = (rig.pins().serial & clock) != 0;
    if (now && !last) {
      word = word << 1 | (level() ? 1u : 0u);
      ++edges;
    }
    last = now;
  }
  return edges == 24 ? word & 0xFFFFFF : 0xFFFFFFFF;
}

}  // namespace brick
