// The servo IC's component. Inputs: word n - 1 has those of channel n, word 4 those of the whole IC; outputs: words 0
// and 1 as core/motor_pins.h has them, word 2 PHASE and SERVO.
#include <brick/servo_ic.h>

#include "systemc/component/chip.h"
#include "systemc/component/servo_ic/servo_ic_pins.h"
#include "systemc/core/motor_pins.h"

namespace brick::component {

void add_motor_pins(std::vector<PinInfo>& table, const std::string& prefix, unsigned input_word, unsigned output_word) {
  const auto add = [&](const MotorRow& row, const std::string& channel, unsigned n) {
    PinInfo info = row.info;
    info.name = prefix + channel + info.name;
    info.word += (info.direction == PinDirection::kIn ? input_word : output_word) + n * row.word_step;
    info.lsb += n * row.lsb_step;
    table.push_back(info);
  };
  for (const MotorRow& row : serial_rows()) add(row, "", 0);
  for (unsigned n = 0; n < kChannels; ++n)
    for (const MotorRow& row : channel_rows()) add(row, "ch" + std::to_string(n + 1) + "_", n);
}

const std::vector<PinInfo>& ServoIc::pin_table() {
  static const std::vector<PinInfo> table = [] {
    std::vector<PinInfo> rows = servo_ic_rows();
    add_motor_pins(rows, "", 0, 0);
    return rows;
  }();
  return table;
}

ServoIc::ServoIc(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine)
    : Component(name, time, pin_table(), {{4, 32 * 8}}),
      ServoIcPins(*this, ""),
      ServoIcSerialPins(*this, ""),
      registers("registers"),
      ch{ServoIcChannel{*this, 1}, ServoIcChannel{*this, 2}, ServoIcChannel{*this, 3}, ServoIcChannel{*this, 4}} {
  registers.register_b_transport(this, &ServoIc::transport);
  registers.register_transport_dbg(this, &ServoIc::debug);
  set_chip(engine.factory().servo_ic());
}

}  // namespace brick::component
