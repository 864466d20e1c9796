// One Verilated servo_channel, behind the pin synchroniser, with SCLK at every edge of clk_ref: the fastest way through
// millions of SCLK periods. A step is one period; clk_pwm, which only the PWM uses, rests. The Verilated header stays
// in the .cpp.
#pragma once

#include <cstdint>
#include <memory>

namespace brick {

class RtlServoChannel {
 public:
  RtlServoChannel();
  ~RtlServoChannel();
  void step(std::int64_t periods = 1);
  void pins(unsigned levels);  // as status bits 23..12
  void latch();                // PHASE and SERVO fall, one period
  void write(bool x, unsigned offset, std::uint32_t word);
  std::uint32_t read(bool x, unsigned offset);
  void read_capture();  // X:+3, with its side effect

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace brick
