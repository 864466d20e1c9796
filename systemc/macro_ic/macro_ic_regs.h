// Model of rtl/macro_ic/macro_ic_regs.sv: the registers of a MACRO IC as far as they are built. All but clock and PWM
// control are storage. A MACROGATE has a direction bit for PHASE only and no supplementary channels; the kind is a
// strap that may change while the registers keep their content. A write belongs to a clk_ref edge that the owner
// chooses.
#pragma once

#include <array>
#include <cstdint>

#include <systemc>

#include "rtl/regs/brick_regs.hpp"

namespace brick {

class MacroIcRegs : public sc_core::sc_module {
 public:
  explicit MacroIcRegs(const sc_core::sc_module_name& name) : sc_module(name) {}

  bool gate = false;  // input: 1 = MACROGATE, 0 = DSPGATE2

  void reset() {
    for (unsigned i = 0; i < kRegister.size(); ++i) word_[i] = kRegister[i].reset;
  }

  // `offset` is 0..63; words that are not built read 0 and ignore writes.
  std::uint32_t read(bool x, unsigned offset) const {
    const unsigned i = index(x, offset);
    if (i == kRegister.size() || (gate && i >= kSupplementary)) return 0;
    return gate && i == kClock ? kServoExternal.set(word_[i], 0) : word_[i];
  }
  void write(bool x, unsigned offset, std::uint32_t value) {
    const unsigned i = index(x, offset);
    if (i != kRegister.size()) word_[i] = value & kRegister[i].written;
  }

  bool phase_ext() const {
    return regs::macro_ic::clock_control::kPhaseExternal.get(word_[kClock]) != regs::clock_direction::kOutput;
  }
  bool servo_ext() const {  // a MACROGATE has no servo clock to drive
    return gate || kServoExternal.get(word_[kClock]) != regs::clock_direction::kOutput;
  }
  unsigned phase_div() const { return regs::macro_ic::clock_control::kPhaseDivider.get(word_[kClock]); }
  unsigned servo_div() const { return regs::macro_ic::clock_control::kServoDivider.get(word_[kClock]); }
  unsigned max_count() const { return regs::macro_ic::pwm_control::kMaxCount.get(word_[kPwm]); }

 private:
  static constexpr regs::Field kServoExternal = regs::macro_ic::clock_control::kServoExternal;
  static constexpr unsigned kClock = 0, kPwm = 1,
                            kSupplementary = 7;  // places in the list; from the last on: DSPGATE2 only
  static constexpr std::array kRegister{
      regs::macro_ic::kClockControl,    regs::macro_ic::kPwmControl,     regs::macro_ic::kAdcStrobe,
      regs::macro_ic::kRingControl,     regs::macro_ic::kNodeActivation, regs::macro_ic::kJioData,
      regs::macro_ic::kMultiplexerData, regs::macro_ic::kSupplementary1, regs::macro_ic::kSupplementary2};

  static unsigned index(bool x, unsigned offset) {
    unsigned i = 0;
    while (i < kRegister.size() && (kRegister[i].address != offset || (kRegister[i].space == 'X') != x)) ++i;
    return i;
  }

  std::array<std::uint32_t, kRegister.size()> word_{};
};

}  // namespace brick
