// Model of rtl/host/host_interrupt.sv: the interrupt line of the host bus, which rises anew for all that is left after
// a service. docs/interrupt_controller.md.
#pragma once

#include <systemc>

#include "systemc/host/inputs.h"
#include "systemc/host/ref_clocked_block.h"

namespace brick {

class HostInterrupt final : public sc_core::sc_module, public RefClockedBlock {
 public:
  explicit HostInterrupt(const sc_core::sc_module_name& name) : sc_module(name) {}

  static constexpr unsigned kIrqLowClocks = 4;

  using Inputs = HostInterruptInputs;
  Inputs in;

  bool irq() const { return irq_; }

 private:
  bool next() const { return in.request && !in.served && low_ == 0; }
  bool idle() const override { return next() == irq_ && low_ == 0; }
  void step() override {
    const bool rises = next();
    if (irq_ && !rises)
      low_ = kIrqLowClocks - 1;
    else if (low_ != 0)
      --low_;
    irq_ = rises;
  }
  void reset_registers() override {
    irq_ = false;
    low_ = 0;
  }

  bool irq_{};
  unsigned low_{};  // edges at which it has still to stay low
};

}  // namespace brick
