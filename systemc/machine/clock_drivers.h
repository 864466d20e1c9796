// Who drives PHASE and SERVO: follows the direction bits that the CPU writes into the gate ICs, so that a contention on
// the nets (pin clock.conflict, docs/clock_select.md) can be told with the names of the ICs and of their variables.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/core/ticks.h"

namespace brick {

class ClockDrivers {
 public:
  void reset() { words_.fill(regs::servo_ic::kClockControl.reset); }

  // A write cycle to a gate IC; anything but a clock word is ignored.
  void write(bool x, std::uint32_t address, std::uint32_t value) {
    for (unsigned ic = 0; x && ic < words_.size(); ++ic)
      if (clock_word(regs::kGateIcs[ic]) == address) words_[ic] = value;
  }

  // "servo IC 0 (I7007) and MACRO IC 0 (I6807)": all that drive one of the nets, and the jumper.
  std::string names(std::uint32_t fitted, bool external) const {
    std::string text;
    for (unsigned ic = 0; ic < words_.size(); ++ic)
      if ((fitted >> ic & 1) != 0 && drives(words_[ic])) text += joint(text) + name(regs::kGateIcs[ic]);
    return external ? text + joint(text) + "the external clocks (E1)" : text;
  }

  // `tick` is that of the pin's rise, the third after the first disagreement.
  std::string contention(Tick tick, std::uint32_t fitted, bool external) const {
    const Tick first = tick - kDelay;
    return fmt::format(
        "clock contention from tick {} ({:.3f} us): {} drive PHASE or SERVO and disagree for more than 2 ticks; "
        "expected one source",
        first, static_cast<double>(tick_to_fs(first)) * 1e-9, names(fitted, external));
  }

 private:
  static constexpr Tick kDelay = 3;

  static std::string joint(const std::string& before) { return before.empty() ? "" : " and "; }
  static std::string name(const regs::GateIc& ic) {
    return fmt::format("{} IC {} (I{})", ic.macro ? "MACRO" : "servo", ic.name, ic.direction_variable);
  }
  static std::uint32_t clock_word(const regs::GateIc& ic) {
    return ic.base + (ic.macro ? regs::macro_ic::kClockControl : regs::servo_ic::kClockControl).address;
  }
  static bool drives(std::uint32_t word) {
    namespace field = regs::servo_ic::clock_control;  // a MACRO IC has them at the same places
    return field::kPhaseExternal.get(word) == regs::clock_direction::kOutput ||
           field::kServoExternal.get(word) == regs::clock_direction::kOutput;
  }
  static_assert(regs::servo_ic::clock_control::kPhaseExternal.lsb == regs::macro_ic::clock_control::kPhaseExternal.lsb);
  static_assert(regs::servo_ic::clock_control::kServoExternal.lsb == regs::macro_ic::clock_control::kServoExternal.lsb);

  std::array<std::uint32_t, regs::kGateIcs.size()> words_{};  // as written, with the direction bits
};

}  // namespace brick
