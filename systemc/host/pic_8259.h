// Model of rtl/host/pic_8259.sv: the 8259A of the original PMAC PC. docs/pic_8259.md.
#pragma once

#include <cstdint>

#include <systemc>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/host/inputs.h"
#include "systemc/host/ref_clocked_block.h"

namespace brick {

class Pic8259 final : public sc_core::sc_module, public RefClockedBlock {
 public:
  explicit Pic8259(const sc_core::sc_module_name& name) : sc_module(name) { reset_registers(); }

  using Inputs = Pic8259Inputs;
  Inputs in;

  std::uint8_t rdata() const;
  std::uint8_t irr() const { return line2_ & (level_ ? 0xFF : armed_); }
  std::uint8_t isr() const { return isr_; }
  std::uint8_t imr() const { return imr_; }
  bool level() const { return level_; }
  bool request() const { return pending(); }
  bool served() const { return pending() && (reads_poll() || (in.rd && in.addr == kAcknowledge)); }

 private:
  enum class Step : std::uint8_t { kReady, kIcw2, kIcw3, kIcw4 };  // what the next write to address 1 is
  enum Address : unsigned {                                        // several words share the first two
    kCommand = regs::pic_8259::kIcw1.address & 3,
    kMask = regs::pic_8259::kOcw1.address & 3,
    kAcknowledge = regs::pic_8259::kVector.address & 3
  };
  static constexpr unsigned kDefaultLevel = regs::pic_8259::poll::kIr.get(
      regs::pic_8259::kPoll.reset);  // of a request that has gone, and the lowest after ICW1

  bool idle() const override;
  void step() override;
  void reset_registers() override;

  // Levels in the order of priority: 0 is the one above the lowest, 8 none of `bits`.
  unsigned rank(std::uint8_t bits) const;
  unsigned level_of(unsigned rank) const { return (rank + lowest_ + 1) & 7; }
  std::uint8_t serviced() const { return isr_ & ~(special_ ? imr_ : 0); }  // levels that hold off others
  bool pending() const { return step_ == Step::kReady && rank(irr() & ~imr_) < rank(serviced()); }
  unsigned acknowledged() const { return pending() ? level_of(rank(irr() & ~imr_)) : kDefaultLevel; }
  bool reads_poll() const { return in.rd && poll_ && in.addr <= kMask; }

  void acknowledge();
  void write_command();
  void write_icw1();
  void write_ocw2();
  void write_second();

  std::uint8_t line1_, line2_;
  std::uint8_t armed_;  // the line has been low since its last acknowledge
  std::uint8_t isr_, imr_, vector_;
  unsigned lowest_;
  Step step_;
  bool icw3_, icw4_;  // will be written
  bool level_, aeoi_, turn_, special_, read_isr_, poll_;
};

}  // namespace brick
