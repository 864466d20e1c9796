#include <brick/clock_select.h>

#include "systemc/component/chip.h"
#include "systemc/component/clock_select_words.h"

namespace brick::component {

const std::vector<PinInfo>& ClockSelect::pin_table() {
  namespace words = clock_select_words;
  static_assert(kIcs == words::kIcs);
  constexpr PinDirection kIn = PinDirection::kIn, kOut = PinDirection::kOut;
  static const std::vector<PinInfo> table = [] {
    std::vector<PinInfo> rows{
        {"rst_n", kIn, words::kControl, words::kRstN, 1, 1, "servo-ic:7.2", "reset, asynchronous, active low"},
        {"fitted", kIn, words::kFitted, 0, kIcs, (1u << kIcs) - 1, "servo-ic:1.2", "ICs that count"}};
    const auto of_each = [&rows](const std::string& name, unsigned word, std::uint32_t idle, const char* meaning) {
      for (unsigned ic = 0; ic < kIcs; ++ic)
        rows.push_back({name + std::to_string(ic), kIn, word, ic, 1, idle, "servo-ic:7.2", meaning});
    };
    of_each("phase_i", words::kPhaseIn, 1, "PHASE as the IC drives it");
    of_each("servo_i", words::kServoIn, 1, "SERVO as the IC drives it");
    of_each("phase_oe_i", words::kPhaseOe, 0, "the IC drives PHASE");
    of_each("servo_oe_i", words::kServoOe, 0, "the IC drives SERVO");
    const std::vector<PinInfo> others{
        {"ext_clock", kIn, words::kControl, words::kExtClock, 1, 0, "servo-ic:7.3",
         "jumper E1: PHASE and SERVO come from outside"},
        {"ext_phase", kIn, words::kControl, words::kExtPhase, 1, 1, "servo-ic:7.3", "PHASE from outside"},
        {"ext_servo", kIn, words::kControl, words::kExtServo, 1, 1, "servo-ic:7.3", "SERVO from outside"},
        {"phase", kOut, 0, words::kPhase, 1, 0, "servo-ic:7.2", "PHASE net"},
        {"servo", kOut, 0, words::kServo, 1, 0, "servo-ic:7.2", "SERVO net"},
        {"phase_source", kOut, 0, words::kSource, 5, 0, "servo-ic:7.1",
         "IC that drives PHASE; 30 from outside, 31 none"},
        {"conflict", kOut, 0, words::kConflict, 1, 0, "servo-ic:7.2", "drivers of a net disagree"}};
    rows.insert(rows.end(), others.begin(), others.end());
    return rows;
  }();
  return table;
}

ClockSelect::ClockSelect(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine)
    : Component(name, time, pin_table()),
      rst_n(*this, "rst_n"),
      fitted(*this, "fitted"),
      phase_i(pin_array<In<>, kIcs>(*this, "phase_i")),
      servo_i(pin_array<In<>, kIcs>(*this, "servo_i")),
      phase_oe_i(pin_array<In<>, kIcs>(*this, "phase_oe_i")),
      servo_oe_i(pin_array<In<>, kIcs>(*this, "servo_oe_i")),
      ext_clock(*this, "ext_clock"),
      ext_phase(*this, "ext_phase"),
      ext_servo(*this, "ext_servo"),
      phase(*this, "phase"),
      servo(*this, "servo"),
      phase_source(*this, "phase_source"),
      conflict(*this, "conflict") {
  set_chip(engine.factory().clock_select());
}

}  // namespace brick::component
