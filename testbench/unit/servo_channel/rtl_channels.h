// The Verilated channels_bench, one clk_pwm edge at a time. The Verilated header stays in the .cpp.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "systemc/core/ticks.h"

namespace brick {

struct ChannelInputs {
  bool rst_n = true, trip = false, phase = true, servo = true;
  bool x = false, we = false, read_done = false;
  unsigned addr = 0;
  std::uint32_t wdata = 0;
  std::array<unsigned, 4> pins{};  // bits as status bits 23..12
  unsigned adc_a = 0, adc_b = 0;
};

struct ChannelPins {
  std::uint32_t pwm = 0;     // per channel C bottom .. A top
  std::uint32_t others = 0;  // EQU, AENA, DAC B, DAC A, DIR, PULSE
  unsigned serial = 0;       // ADC strobe, ADC clock, DAC strobe, DAC clock
  bool phase = true, servo = true;
  bool operator==(const ChannelPins& o) const {
    return pwm == o.pwm && others == o.others && serial == o.serial && phase == o.phase && servo == o.servo;
  }
};

class RtlChannels {
 public:
  RtlChannels();
  ~RtlChannels();
  void drive(const ChannelInputs& in);
  void tick(bool ref);
  ChannelPins pins() const;
  std::uint32_t rdata() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace brick
