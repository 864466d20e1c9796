// One Verilated servo_channel, behind the pin synchroniser, with SCLK at every edge of clk_ref: the fastest way through
// millions of SCLK periods. A step is one period; clk_pwm, which only the PWM uses, rests.
#pragma once

#include <cstdint>

#include "testbench/unit/rtl/rtl_block.h"

namespace brick {

struct ServoChannelInputs {
  bool x = false, we = false;
  unsigned addr = 0;
  std::uint32_t wdata = 0;
  bool read_capture = false, latch = false;  // latch: PHASE and SERVO fall
  unsigned pins = 0;                         // as status bits 23..12
};

class RtlServoChannel : private RtlBlock<ServoChannelInputs, std::uint32_t> {  // shows the word at the address
 public:
  RtlServoChannel();
  void step(std::int64_t periods = 1);
  void pins(unsigned levels) { in.pins = levels; }
  void latch() { step_with(&ServoChannelInputs::latch); }
  void write(bool x, unsigned offset, std::uint32_t word);
  std::uint32_t read(bool x, unsigned offset);
  void read_capture() { step_with(&ServoChannelInputs::read_capture); }  // X:+3, with its side effect

 private:
  void step_with(bool ServoChannelInputs::*strobe);  // high for one period
};

}  // namespace brick
