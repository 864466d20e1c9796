// Seeds of a Verilated board: flip-flops start by that of the engine, the dual-ported RAM by that of the board, as with
// the model.
#pragma once

#include "systemc/cosim/engines.h"

namespace brick::component {

inline RtlOptions board_options(std::uint64_t engine_seed, std::uint64_t ram_seed) {
  return {engine_seed, false, ram_seed};
}

}  // namespace brick::component
