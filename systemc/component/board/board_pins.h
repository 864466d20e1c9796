// The pins of the board, as board_table.cpp has them from rtl/pins/board.pins; without the motor side.
#pragma once

#include <vector>

#include "systemc/component/include/brick/pins.h"

namespace brick::component {

const std::vector<PinInfo>& board_rows();

}  // namespace brick::component
