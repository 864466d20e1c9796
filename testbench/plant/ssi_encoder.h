// An absolute encoder with a serial interface (SSI) at two wires. The first fall of its clock holds position and
// parity; each rise shifts a bit out, the highest first, zeros after the last. A monoflop ends the word when the clock
// has rested; a word that is asked for before that is the same once more. Wrong on purpose: other length than the
// controller clocks, bit errors by seed, no encoder at all, a slow line. Rules of the line: servo-ic:11.9.
#pragma once

#include <cstdint>
#include <deque>
#include <utility>

#include "systemc/core/ticks.h"
#include "testbench/plant/random.h"

namespace brick::plant {

struct SsiEncoderParameters {
  enum class Parity { kNone, kOdd, kEven };
  unsigned bits = 24;  // of a revolution and of the count of revolutions together: 1 to 32
  bool gray = false;
  Parity parity = Parity::kNone;
  Tick monoflop = 2359;      // 20 us
  Tick delay = 0;            // from a clock edge at the controller's pin to the level of its data pin
  bool missing = false;      // nothing connected: pulled up
  unsigned error_every = 0;  // one word in so many has a wrong bit; 0: none
};

class SsiEncoder {
 public:
  SsiEncoder(const SsiEncoderParameters& parameters, std::uint64_t seed, std::uint64_t stream)
      : par_(parameters), random_(seed, stream) {}

  // An edge of its clock at tick t; `position` counts only at a first fall. What comes of it is seen in level().
  void clock(Tick t, bool level, std::uint64_t position);

  // Data pin as it stands after tick t; times do not go back.
  bool level(Tick t);
  Tick next_change() const { return changes_.empty() ? kNever : changes_.front().first; }

  std::uint64_t held() const { return held_; }  // the position that the last first fall found
  std::uint64_t word() const { return word_; }  // what is sent of it, the lowest bit last
  bool spoilt() const { return spoilt_; }       // with a bit turned over
  const SsiEncoderParameters& parameters() const { return par_; }

  unsigned length() const { return par_.bits + (par_.parity == SsiEncoderParameters::Parity::kNone ? 0u : 1u); }

 private:
  void hold(std::uint64_t position);
  void show(Tick t, bool level);

  SsiEncoderParameters par_;
  Random random_;
  std::uint64_t word_ = 0, held_ = 0;
  unsigned sent_ = 0;  // bits of the word that have been shifted out
  bool spoilt_ = false;
  Tick last_ = -kLongAgo, low_ = 0;  // last edge; how long the clock was low last
  bool level_ = true;
  std::deque<std::pair<Tick, bool>> changes_;  // of the data pin that are on their way

  static constexpr Tick kLongAgo = Tick{1} << 60;
};

}  // namespace brick::plant
