// Rows of the pin table for the channels of a servo IC, alone or on a board.
#pragma once

#include <string>
#include <vector>

#include "systemc/component/include/brick/pins.h"

namespace brick::component {

// `prefix` of all names; inputs of channel n in word `input_word` + n - 1, outputs in the two words from `output_word`.
void add_motor_pins(std::vector<PinInfo>& table, const std::string& prefix, unsigned input_word, unsigned output_word);

}  // namespace brick::component
