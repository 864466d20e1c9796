// The Verilated MACRO IC with the same calls as the model, one clk_pwm edge at a time. The Verilated header stays in
// the .cpp.
#pragma once

#include <cstdint>
#include <memory>

#include "systemc/core/ticks.h"

namespace brick {

class RtlMacroIc {
 public:
  RtlMacroIc();
  ~RtlMacroIc();

  struct Inputs {
    bool rst_n = false;
    bool gate = false;  // MACROGATE
    bool sel = false, x = false, we = false;
    unsigned addr = 0;
    std::uint32_t wdata = 0;
    bool phase = true, servo = true;
  };
  Inputs in;

  void tick();    // the next clk_pwm edge, and clk_ref with every third
  void settle();  // combinational paths follow the inputs as they stand
  Tick now() const { return now_; }

  bool phase() const;
  bool servo() const;
  bool phase_oe() const;
  bool servo_oe() const;
  std::uint32_t rdata();  // combinational, with the present address

 private:
  void drive();
  struct Impl;
  std::unique_ptr<Impl> impl_;
  Tick now_ = 0;
};

}  // namespace brick
