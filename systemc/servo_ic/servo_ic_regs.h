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

  void reset() { word_ = kReset; }

  // `offset` is 0..31; words that are not built read 0 and ignore writes.
  std::uint32_t read(bool x, unsigned offset) const { return is_global(x, offset) ? word_[offset >> 3] : 0; }
  void write(bool x, unsigned offset, std::uint32_t value) {
    if (is_global(x, offset)) word_[offset >> 3] = value & kWritable[offset >> 3];
  }

  bool phase_ext() const { return regs::servo_ic::clock_control::kPhaseExternal.get(word_[kClock]) != 0; }
  bool servo_ext() const { return regs::servo_ic::clock_control::kServoExternal.get(word_[kClock]) != 0; }
  unsigned phase_div() const { return regs::servo_ic::clock_control::kPhaseDivider.get(word_[kClock]); }
  unsigned servo_div() const { return regs::servo_ic::clock_control::kServoDivider.get(word_[kClock]); }
  unsigned clock_dividers() const {
    return word_[kClock] >> regs::servo_ic::clock_control::kSclkDivider.lsb & 0xFFF;
  }  // all four
  std::uint32_t dac_strobe() const { return word_[kDacStrobe]; }
  std::uint32_t adc_strobe() const { return word_[kAdcStrobe]; }
  unsigned deadtime() const { return regs::servo_ic::pwm_control::kDeadtime.get(word_[kPwm]); }
  unsigned max_count() const { return regs::servo_ic::pwm_control::kMaxCount.get(word_[kPwm]); }

 private:
  enum { kClock, kDacStrobe, kAdcStrobe, kPwm };
  static constexpr std::array<std::uint32_t, 4> kReset{
      regs::servo_ic::kClockControl.reset, regs::servo_ic::kDacStrobe.reset, regs::servo_ic::kAdcStrobe.reset,
      regs::servo_ic::kPwmControl.reset};
  static constexpr std::array<std::uint32_t, 4> kWritable{
      regs::servo_ic::kClockControl.written, regs::servo_ic::kDacStrobe.written, regs::servo_ic::kAdcStrobe.written,
      regs::servo_ic::kPwmControl.written};
  static bool is_global(bool x, unsigned offset) { return x && (offset & 7) == 4; }

  std::array<std::uint32_t, 4> word_ = kReset;
};

}  // namespace brick
