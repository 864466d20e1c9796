// Input filter of a servo IC's channel as a rule (servo-ic:5.3/1): a pin's level is the majority of its last three SCLK
// samples, so one sample never passes and two in a row always do.
#pragma once

#include <cstdint>

namespace brick {

class SclkFilter {
 public:
  explicit SclkFilter(std::uint16_t pins) : s0_(pins), s1_(pins), s2_(pins) {}

  // `samples` 1 is no filter: a deliberately wrong rule.
  void sample(std::uint16_t pins, unsigned samples = 3) {
    s2_ = samples == 1 ? pins : s1_;
    s1_ = samples == 1 ? pins : s0_;
    s0_ = pins;
  }
  std::uint16_t level() const { return static_cast<std::uint16_t>((s0_ & s1_) | (s0_ & s2_) | (s1_ & s2_)); }

 private:
  std::uint16_t s0_, s1_, s2_;
};

}  // namespace brick
