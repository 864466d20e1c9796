// The pins of a servo IC, alone or on a board, as servo_ic_table.cpp has them from rtl/pins/servo_ic.pins.
#pragma once

#include <string>
#include <vector>

#include "systemc/component/include/brick/pins.h"

namespace brick::component {

struct MotorRow {
  PinInfo info;                  // of channel 1; the name without that of the channel
  unsigned word_step, lsb_step;  // to the next channel
};

const std::vector<PinInfo>& servo_ic_rows();  // of the whole IC alone
const std::vector<MotorRow>& serial_rows();
const std::vector<MotorRow>& channel_rows();

// `prefix` of all names; inputs of channel n in word `input_word` + n - 1, outputs in the two words from `output_word`.
void add_motor_pins(std::vector<PinInfo>& table, const std::string& prefix, unsigned input_word, unsigned output_word);

}  // namespace brick::component
