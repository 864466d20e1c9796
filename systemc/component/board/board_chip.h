// A board of any engine (systemc/core/board.h) behind the pins of its component.
#pragma once

#include <memory>

#include "systemc/component/chip.h"
#include "systemc/core/board.h"

namespace brick::component {

// `foresees`: the engine's quiet_until() looks ahead, for all its pins.
std::unique_ptr<Chip> board_chip(std::unique_ptr<brick::Board> board, std::uint32_t fitted, bool foresees);

}  // namespace brick::component
