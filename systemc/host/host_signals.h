// Model of rtl/host/host_signals.sv: the latches of IPOS, BREQ, EROR and F1ER, and of CTRL0 and CTRL1.
// docs/host_signals.md.
#pragma once

#include <cstdint>

#include <systemc>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/host/inputs.h"
#include "systemc/host/ref_clocked_block.h"

namespace brick {

class HostSignals final : public sc_core::sc_module, public RefClockedBlock {
 public:
  explicit HostSignals(const sc_core::sc_module_name& name) : sc_module(name) {}

  using Inputs = HostSignalsInputs;
  Inputs in;

  std::uint8_t rdata() const { return latch_; }
  std::uint8_t ctrl() const { return ctrl_; }
  bool ipos() const { return regs::board_latches::host_signals::kIpos.is_set(latch_); }
  bool breq() const { return regs::board_latches::host_signals::kBreq.is_set(latch_); }
  bool eror() const { return regs::board_latches::host_signals::kEror.is_set(latch_); }
  bool f1er() const { return regs::board_latches::host_signals::kF1er.is_set(latch_); }

 private:
  static constexpr std::uint8_t kWritten = regs::board_latches::kHostSignals.written;
  static constexpr std::uint8_t kCtrlWritten = regs::board_latches::kControlOutputs.written;

  bool idle() const override {
    return (!in.wr || (in.wdata & kWritten) == latch_) &&
           (in.trip ? ctrl_ == 0 : !in.ctrl_wr || (in.wdata & kCtrlWritten) == ctrl_);
  }
  void step() override {
    if (in.wr) latch_ = in.wdata & kWritten;
    if (in.trip)
      ctrl_ = 0;
    else if (in.ctrl_wr)
      ctrl_ = in.wdata & kCtrlWritten;
  }
  void reset_registers() override { latch_ = ctrl_ = 0; }

  std::uint8_t latch_{}, ctrl_{};
};

}  // namespace brick
