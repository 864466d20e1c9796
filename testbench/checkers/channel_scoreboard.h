// Scoreboard of one channel's input side: it is given the levels on its pins with their ticks, and says at which tick
// the counter and EQU change, and what the registers hold. Rules of servo-ic:5.3 to servo-ic:5.10 (sclk_filter.h,
// quadrature.h, capture.h, compare.h); the only thing learnt from the hardware is at which ticks SCLK falls
// (synchronise()).
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <vector>

#include "systemc/core/motor_pins.h"
#include "systemc/core/ticks.h"
#include "testbench/checkers/capture.h"
#include "testbench/checkers/compare.h"
#include "testbench/checkers/quadrature.h"
#include "testbench/checkers/sclk_filter.h"

namespace brick {

class ChannelScoreboard {
 public:
  static constexpr Tick kSync = 3;  // a pin that is driven at tick t is seen by SCLK at t + 3 and later: two flip-flops
  static constexpr unsigned kDecode =
      2;  // SCLK periods from the first sample to the count: two samples, then the decoder

  struct Change {
    Tick tick;
    std::int64_t value;
    bool operator==(const Change& o) const { return tick == o.tick && value == o.value; }
  };

  // `idle`: the pins before the first drive()
  explicit ChannelScoreboard(std::uint16_t idle = kIdleChannelPins)
      : decoder{idle}, capture{idle}, filter{idle}, pins_(idle) {}

  // Earliest and latest tick of a count whose pin changed at `tick`, before SCLK is known.
  static Tick earliest(Tick tick, Tick period) { return tick + kSync + kDecode * period; }
  static Tick latest(Tick tick, Tick period) { return earliest(tick, period) + period - 1; }

  // SCLK has an edge at tick `edge` and every `period` ticks. From tick `now` on, when everything is quiet, it is
  // followed.
  void synchronise(Tick edge, Tick period, Tick now);
  void touch() { busy_ = 8; }  // after a change of the public settings below

  void drive(Tick tick, std::uint16_t pins) { driven_.push_back({tick, pins}); }
  void pulse(Tick tick, int direction) {
    pulses_.push_back({tick, direction});
  }                         // leading edge of the channel's own PFM pulse
  void advance(Tick tick);  // all SCLK edges up to `tick`

  Quadrature decoder;
  Capture capture;
  Compare compare;
  SclkFilter filter;
  std::function<void(Tick, std::uint32_t from, int)> on_count;  // compares of other channels that follow this one
  bool own_compare = true;                                      // I7mn1 = 0
  void follow(Tick tick, std::uint32_t from, int direction);    // a count of the source that compare follows

  std::vector<Change> counts, equs;  // every change, until taken
  std::uint16_t level() const { return filter.level(); }
  bool keep_levels = false;
  std::vector<Change> levels;                      // filtered inputs, if kept
  std::uint32_t status(std::uint32_t mask) const;  // X:+0 as far as it follows from the rules: not ENC_LOSS
  std::int64_t t2(Tick tick) const {
    return index(tick) - decoder.last_count();
  }  // SCLK periods from the last count to `tick`
  Tick period() const { return period_; }

 private:
  struct Driven {
    Tick tick;
    std::uint16_t pins;
  };
  struct Pulse {
    Tick tick;
    int direction;
  };
  std::int64_t index(Tick tick) const;
  void edge(std::int64_t k);

  std::uint16_t pins_;
  std::deque<Driven> driven_;
  std::deque<Pulse> pulses_;
  Tick phase_ = 0, period_ = 12;
  std::int64_t next_ = 0;  // SCLK edge to execute next
  unsigned busy_ = 8;      // edges until nothing can move any more
};

}  // namespace brick
