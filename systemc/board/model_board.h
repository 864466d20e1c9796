// Makes the SystemC model of the board. Free of SystemC, for whoever needs the Board face alone.
#pragma once

#include <cstdint>
#include <memory>

#include "systemc/core/board.h"

namespace brick {

std::unique_ptr<Board> make_model_board(std::uint32_t fitted);  // BoardTop

}  // namespace brick
