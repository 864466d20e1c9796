// Where the packed words of a board's component have what core/board_pins.h, cosim/drive.h and core/motor_pins.h pack.
#pragma once

#include "systemc/component/servo_ic/servo_ic_words.h"
#include "systemc/core/motor_pins.h"
#include "systemc/cosim/drive.h"

namespace brick::component::board_words {

constexpr unsigned kReset = kBoardInputWords;  // a word of its own: bit 0 is rst_n
// The k-th of the fitted servo ICs has a word for each channel, laid out as in servo_ic_words.h, and two of outputs.
constexpr unsigned motor_input(unsigned k) { return kReset + 1 + kChannels * k; }
constexpr unsigned motor_output(unsigned k) { return kBoardOutputWords + 2 * k; }

constexpr std::uint32_t kServoIcs = (1u << kMaxServoIcs) - 1;  // of a mask of fitted ICs

}  // namespace brick::component::board_words
