// Model of rtl/board/panel_port.sv: the control panel inputs through two stages on clk_ref, and the lamps.
#pragma once

#include <cstdint>

#include <systemc>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/host/ref_clocked_block.h"

namespace brick {

class PanelPort : public sc_core::sc_module, public RefClockedBlock {
 public:
  explicit PanelPort(const sc_core::sc_module_name& name) : sc_module(name) {}

  std::uint16_t jpan = kIdle;  // input pins

  bool fitted = false, breq = false, eror = false, f1er = false, ipos = false;

  std::uint16_t rdata() const { return jpan2_; }
  bool brld_n() const { return !(fitted && breq); }
  bool erld_n() const { return !(fitted && eror); }
  bool f1ld_n() const { return !(fitted && f1er); }
  bool ipld_n() const { return !(fitted && ipos); }

 private:
  static constexpr std::uint16_t kIdle = regs::jpan::kInputs.reset;

  bool idle() const override { return jpan == jpan1_ && jpan1_ == jpan2_; }
  void step() override {
    jpan2_ = jpan1_;
    jpan1_ = jpan;
  }
  void reset_registers() override { jpan1_ = jpan2_ = kIdle; }

  std::uint16_t jpan1_{}, jpan2_{};
};

}  // namespace brick
