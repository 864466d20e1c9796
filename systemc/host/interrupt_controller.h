// Model of rtl/host/interrupt_controller.sv: eight lines, edge latches, mask, one interrupt.
// docs/interrupt_controller.md.
#pragma once

#include <cstdint>

#include <systemc>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/host/inputs.h"
#include "systemc/host/ref_clocked_block.h"

namespace brick {

class InterruptController final : public sc_core::sc_module, public RefClockedBlock {
 public:
  explicit InterruptController(const sc_core::sc_module_name& name) : sc_module(name) {}

  using Inputs = InterruptControllerInputs;
  Inputs in;

  std::uint8_t rdata() const { return read(in.addr); }
  std::uint8_t ist() const { return msk_ & ((elr_ & line2_) | (~elr_ & latch_)); }
  std::uint8_t sig() const { return line2_; }
  std::uint8_t msk() const { return msk_; }
  std::uint8_t elr() const { return elr_; }
  bool request() const {  // any IST after the coming edge, a level line a clock later
    const Registers next = coming();
    return (next.msk & ((next.elr & line2_) | (~next.elr & next.latch))) != 0;
  }
  bool served() const { return in.wr && in.addr == kStatus; }

  std::uint8_t read(unsigned addr) const;

 private:
  enum Address : unsigned {
    kStatus = regs::host_io::kPicStatus.address & 3,
    kSignal = regs::host_io::kPicSignal.address & 3,
    kMask = regs::host_io::kPicMask.address & 3,
    kEdgeLevel = regs::host_io::kPicEdgeLevel.address & 3
  };

  struct Registers {
    std::uint8_t latch, msk, elr;
  };
  Registers coming() const;  // after the coming edge

  bool idle() const override;
  void step() override;
  void reset_registers() override;

  std::uint8_t line1_{}, line2_{}, line3_{};  // line3_ is line2_ one edge ago
  std::uint8_t latch_{}, msk_{}, elr_{};
};

}  // namespace brick
