// Makes the SystemC model of the board. Free of SystemC, for whoever needs the Board face alone.
#pragma once

#include <cstdint>
#include <memory>

#include "systemc/core/board.h"

namespace brick {

// BoardTop; `seed` gives the dual-ported RAM its content (systemc/core/start_value.h).
std::unique_ptr<Board> make_model_board(std::uint32_t fitted, std::uint64_t seed = 0);

}  // namespace brick
