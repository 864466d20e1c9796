// Model of rtl/macro_ic/macro_ic.sv: MACRO IC (DSPGATE2 or MACROGATE), clock part. The clock chain is that of the servo
// IC (ClockGen).
#pragma once

#include <cstdint>

#include <systemc>

#include "systemc/core/model_block.h"
#include "systemc/macro_ic/macro_ic_regs.h"
#include "systemc/servo_ic/clock_follower.h"
#include "systemc/servo_ic/clock_gen.h"

namespace brick {

class MacroIc : public sc_core::sc_module, public ClockFollower {
 public:
  explicit MacroIc(const sc_core::sc_module_name& name);

  // Registers as they stand after the last executed edge; a write is executed by that edge, so call advance() first.
  std::uint32_t read(bool x, unsigned offset) const { return regs_.read(x, offset); }
  void write(bool x, unsigned offset, std::uint32_t value);

  // Kind and clock pins; seen by the edges to come.
  void set_gate(bool gate);
  void set_pins(bool phase, bool servo) override {
    clock_gen_.in.phase = phase;
    clock_gen_.in.servo = servo;
  }
  bool phase() const { return clock_gen_.phase(); }
  bool servo() const { return clock_gen_.servo(); }
  const ClockGen& clock_gen() const override { return clock_gen_; }

  Tick next_event() const override { return clock_gen_.next_event(); }
  void advance(Tick t) override { clock_gen_.advance(t); }
  void reset(Tick t) override;

 private:
  void mark() override { clock_gen_.mark(); }
  bool repeats() const override { return clock_gen_.repeats(); }
  void jump(Tick by) override { clock_gen_.jump(by); }
  void apply_registers();

  MacroIcRegs regs_;
  ClockGen clock_gen_;
};

}  // namespace brick
