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
  explicit Pic8259(const sc_core::sc_module_name& name) : sc_module(name) {}

  using Inputs = Pic8259Inputs;
  Inputs in;

  std::uint8_t rdata() const;
  std::uint8_t irr() const { return registers_.irr(line2_); }
  std::uint8_t isr() const { return registers_.isr; }
  std::uint8_t imr() const { return registers_.imr; }
  bool level() const { return registers_.level; }
  // After the coming edge, unless it is served; a line that falls goes a clock later.
  bool request() const { return coming().pending(line2_); }
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

  struct Registers {
    std::uint8_t armed = 0;  // the line has been low since its last acknowledge
    std::uint8_t isr = 0, imr = regs::pic_8259::kOcw1.reset, vector = 0;
    unsigned lowest = kDefaultLevel;
    Step step = Step::kReady;
    bool icw3 = false, icw4 = false;  // will be written
    bool level = false, aeoi = false, turn = false, special = false, read_isr = false, poll = false;

    std::uint8_t irr(std::uint8_t line) const { return line & (level ? 0xFF : armed); }
    // Levels in the order of priority: 0 is the one above the lowest, 8 none of `bits`.
    unsigned rank(std::uint8_t bits) const;
    unsigned level_of(unsigned rank) const { return (rank + lowest + 1) & 7; }
    std::uint8_t serviced() const { return isr & ~(special ? imr : 0); }  // levels that hold off others
    bool pending(std::uint8_t line) const { return step == Step::kReady && rank(irr(line) & ~imr) < rank(serviced()); }
    unsigned acknowledged(std::uint8_t line) const {
      return pending(line) ? level_of(rank(irr(line) & ~imr)) : kDefaultLevel;
    }

    void acknowledge(unsigned acked);
    void write_command(std::uint8_t byte);
    void write_icw1(std::uint8_t byte);
    void write_ocw2(std::uint8_t byte);
    void write_second(std::uint8_t byte);
  };

  bool idle() const override;
  void step() override;
  void reset_registers() override;

  bool pending() const { return registers_.pending(line2_); }
  bool reads_poll() const { return in.rd && registers_.poll && in.addr <= kMask; }
  Registers coming() const;  // after the coming edge

  std::uint8_t line1_{}, line2_{};
  Registers registers_;
};

}  // namespace brick
