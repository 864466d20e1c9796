// Disturbances on input wires: now and then one pin shows the opposite level for a while. Shorter than an SCLK period
// they must not pass the IC's filter, from two SCLK periods on they must. They depend on time and seed only, not on
// what the pins do.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <vector>

#include "systemc/core/motor_pins.h"
#include "systemc/core/ticks.h"
#include "testbench/plant/random.h"

namespace brick::plant {

struct NoiseParameters {
  Tick every = 0;  // mean time between two disturbances, 0 = none; a single one is 0.5 .. 1.5 of it after the last
  Tick shortest = 1, longest = 1;    // ticks
  std::uint16_t pins = 1u << kEncA;  // that can be hit
};

class LineNoise {
 public:
  LineNoise(const NoiseParameters& parameters, Random random) : par_(parameters), random_(random) {
    for (unsigned pin = 0; pin < kChannelPins; ++pin)
      if ((par_.pins >> pin & 1) != 0) pins_.push_back(pin);
    if (par_.every == 0) return;
    if (par_.every < 0 || pins_.empty() || par_.shortest < 1 || par_.longest < par_.shortest)
      throw std::invalid_argument("line noise: no time or no pin");
    next_one();
  }

  // Pins inverted as edge t sees them; t never goes back.
  std::uint16_t mask(Tick t) {
    while (t >= end_) next_one();
    return t >= start_ ? static_cast<std::uint16_t>(1u << pin_) : 0;
  }
  // The first edge after t that sees another mask; t as given to mask().
  Tick next_change(Tick t) const { return t < start_ ? start_ : end_; }

  std::uint64_t over() const { return count_ == 0 ? 0 : count_ - 1; }  // disturbances that have ended

 private:
  void next_one() {
    start_ = (count_++ == 0 ? 0 : end_) + 1 + random_.between(par_.every / 2, par_.every + par_.every / 2);
    end_ = start_ + random_.between(par_.shortest, par_.longest);
    pin_ = pins_[random_.below(pins_.size())];
  }

  NoiseParameters par_;
  Random random_;
  std::vector<unsigned> pins_;
  Tick start_ = kNever, end_ = kNever;
  unsigned pin_ = 0;
  std::uint64_t count_ = 0;
};

}  // namespace brick::plant
