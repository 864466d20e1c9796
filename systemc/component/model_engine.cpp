#include <brick/engine.h>

#include "systemc/board/model_board.h"
#include "systemc/component/board/board_chip.h"
#include "systemc/component/model_chips.h"

namespace brick::component {

std::unique_ptr<Chip> model_board(std::uint32_t fitted, std::uint64_t seed) {
  return board_chip(make_model_board(fitted, seed), fitted, true);
}

Engine model_engine() { return Engine(std::make_shared<ModelFactory>()); }

}  // namespace brick::component
