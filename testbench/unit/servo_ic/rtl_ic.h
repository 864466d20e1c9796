// A gate IC of either kind on the Verilated engine, with the same calls as the model, one clk_pwm edge at a time.
#pragma once

#include <cstdint>

#include "testbench/unit/rtl/rtl_block.h"

namespace brick {

struct IcOutputs {
  bool phase, servo, phase_oe, servo_oe;
  std::uint32_t rdata;
  std::uint64_t motor = 0;  // of a servo IC: the first two words of MotorOutputs
};

template <class Inputs>
class RtlIc : public RtlBlock<Inputs, IcOutputs> {
 public:
  using RtlBlock<Inputs, IcOutputs>::RtlBlock;

  bool phase() const { return this->outputs().phase; }
  bool servo() const { return this->outputs().servo; }
  bool phase_oe() const { return this->outputs().phase_oe; }
  bool servo_oe() const { return this->outputs().servo_oe; }
  std::uint64_t motor() const { return this->outputs().motor; }
  std::uint32_t rdata() {  // combinational, with the present address
    this->settle();
    return this->outputs().rdata;
  }
};

}  // namespace brick
