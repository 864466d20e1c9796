// The Verilated servo IC with the same calls as the model, one clk_pwm edge at a time. The Verilated header stays in
// the .cpp.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "systemc/core/ticks.h"

namespace brick {

struct ServoIcInputs {
  bool rst_n = true, trip = false;
  bool sel = true, x = false, we = false, read_done = false;  // read_done: of the same word
  unsigned addr = 0;
  std::uint32_t wdata = 0;
  bool phase = true, servo = true;
  std::array<unsigned, 4> pins{};  // of a channel, bits as status bits 23..12
  unsigned adc_a = 0, adc_b = 0;   // bit n-1: channel n
};

class RtlServoIc {
 public:
  RtlServoIc();  // in reset and not selected
  ~RtlServoIc();

  ServoIcInputs in;

  void settle();  // what the inputs change without an edge
  void tick();    // the next clk_pwm edge, and clk_ref with every third
  Tick now() const { return now_; }

  bool phase() const;
  bool servo() const;
  bool phase_oe() const;
  bool servo_oe() const;
  std::uint64_t motor() const;  // the first two words of MotorOutputs
  std::uint32_t rdata();        // combinational, with the present address

 private:
  void drive();
  struct Impl;
  std::unique_ptr<Impl> impl_;
  Tick now_ = 0;
};

}  // namespace brick
