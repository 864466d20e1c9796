// Model of rtl/servo_ic/servo_ic_regs.sv: the four registers that serve a whole servo IC (X word at offset 4 of each
// channel). Reset values and fields as in servo-ic:2.6. A write belongs to a clk_ref edge that the owner chooses.
#pragma once

#include <array>
#include <cstdint>

#include <systemc>

#include "rtl/regs/brick_regs.hpp"

namespace brick {

class ServoIcRegs : public sc_core::sc_module {
 public:
  explicit ServoIcRegs(const sc_core::sc_module_name& name) : sc_module(name) {}

  void reset() {
    for (unsigned i = 0; i < kRegister.size(); ++i) word_[i] = kRegister[i].reset;
  }

  // `offset` is 0..31; words that are not built read 0 and ignore writes.
  std::uint32_t read(bool x, unsigned offset) const {
    const unsigned i = place(x, offset);
    return i == kRegister.size() ? 0 : word_[i];
  }
  // After a trip of the watchdog the strobes stay: that of the ADCs commands amplifiers, that of the DACs latches.
  void write(bool x, unsigned offset, std::uint32_t value, bool trip) {
    const unsigned i = place(x, offset);
    if (i != kRegister.size() && !(trip && (i == kDacStrobe || i == kAdcStrobe)))
      word_[i] = value & kRegister[i].written;
  }

  bool phase_ext() const {
    return regs::servo_ic::clock_control::kPhaseExternal.get(word_[kClock]) != regs::clock_direction::kOutput;
  }
  bool servo_ext() const {
    return regs::servo_ic::clock_control::kServoExternal.get(word_[kClock]) != regs::clock_direction::kOutput;
  }
  unsigned phase_div() const { return regs::servo_ic::clock_control::kPhaseDivider.get(word_[kClock]); }
  unsigned servo_div() const { return regs::servo_ic::clock_control::kServoDivider.get(word_[kClock]); }
  std::uint32_t clock_word() const { return word_[kClock]; }  // with the four dividers of the channels
  std::uint32_t dac_strobe() const { return word_[kDacStrobe]; }
  std::uint32_t adc_strobe() const { return word_[kAdcStrobe]; }
  unsigned deadtime() const { return regs::servo_ic::pwm_control::kDeadtime.get(word_[kPwm]); }
  unsigned max_count() const { return regs::servo_ic::pwm_control::kMaxCount.get(word_[kPwm]); }

 private:
  enum { kClock, kDacStrobe, kAdcStrobe, kPwm };
  static constexpr std::array kRegister{regs::servo_ic::kClockControl, regs::servo_ic::kDacStrobe,
                                        regs::servo_ic::kAdcStrobe, regs::servo_ic::kPwmControl};
  static unsigned place(bool x, unsigned offset) {
    unsigned i = 0;
    while (i < kRegister.size() && !(x && kRegister[i].address == offset)) ++i;
    return i;
  }

  std::array<std::uint32_t, kRegister.size()> word_{};
};

}  // namespace brick
