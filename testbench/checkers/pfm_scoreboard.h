// The PFM rules (servo-ic:5.12/1 to servo-ic:5.12/7): one accumulator of 24 bits, stepped at every edge of PFM_CLK,
// exact from power-up on. The scoreboard is told when commands were written and sees the pins. It cannot see how many
// edges of clk_ref lie between a word and its pin; it starts with all small numbers and keeps those that agree with
// every pulse so far.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "systemc/core/ticks.h"

namespace brick {

struct PfmCommand {
  Tick tick;           // written
  std::int32_t value;  // 24 bits, signed
};

// Pins from `tick` on, inversions taken out: bit 0 pulse, bit 1 direction (1 = negative).
struct PfmLevel {
  Tick tick;
  unsigned pins;
};

struct PfmRule {
  Tick clock = 12;      // ticks of a PFM_CLK period
  unsigned width = 15;  // I7m04, 0 as 1
  std::int32_t largest = 1 << 22;
};

class PfmScoreboard {
 public:
  // Judges a stretch that begins with no pulse and no command (`seen` starts with the pins as they stand) and ends
  // likewise at `to`. `grid` is a tick at which PFM_CLK has an edge, seen at any pin of the IC. "" when the pins agree.
  std::string judge(const PfmRule& rule, const std::vector<PfmCommand>& commands, const std::vector<PfmLevel>& seen,
                    Tick grid, Tick to);

  // Of the last stretch: pulses up and down, and whether one began when the last one ended or earlier.
  struct Pulses {
    std::int64_t up = 0, down = 0;
    bool overlap = false;
  };
  const Pulses& pulses() const { return pulses_; }

 private:
  struct Variant {
    Tick late;  // ticks from a write to the first edge of PFM_CLK that can use it
    std::int64_t acc = 0;
    std::vector<PfmLevel> levels{};
    Pulses pulses{};
  };
  static void step(Variant& v, const PfmRule& rule, const std::vector<PfmCommand>& commands, unsigned pins, Tick grid,
                   Tick to);

  std::vector<Variant> variants_{{3}, {6}, {9}};
  Pulses pulses_;
};

}  // namespace brick
