// Input filter of a servo IC's channel as a rule (servo-ic:5.3/1): a pin's level is the majority of its last three SCLK
// samples, so one sample never passes and two in a row always do.
#pragma once

#include <cstdint>

namespace brick {

class SclkFilter {
 public:
  explicit SclkFilter(std::uint16_t pins) : s0_(pins), s1_(pins), s2_(pins) {}

  void sample(std::uint16_t pins) {
    s2_ = s1_;
    s1_ = s0_;
    s0_ = pins;
  }
  std::uint16_t level() const {
    if (lets_one_pass) return s1_;
    return static_cast<std::uint16_t>((s0_ & s1_) | (s0_ & s2_) | (s1_ & s2_));
  }
  bool lets_one_pass = false;  // deliberately wrong rule: as late as the right one, but one sample is enough

 private:
  std::uint16_t s0_, s1_, s2_;
};

}  // namespace brick
