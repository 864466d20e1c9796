// Makes a board for an engine; the model alone is made by systemc/board/model_board.h. The Verilated headers stay
// behind this line.
#pragma once

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "systemc/board/model_board.h"
#include "systemc/core/board.h"

namespace brick {

struct RtlOptions {
  // 0: all flip-flops start as zero. Else they start at random, by this seed, and reset must bring them to where the
  // model is.
  std::uint64_t seed = 0;
  bool seeded_bug = false;  // negative control, see rtl/board/board_sim.sv
  // Of the content of the dual-ported RAM (core/start_value.h), as the model's own; none: `seed`.
  std::optional<std::uint64_t> ram_seed = std::nullopt;
};

// Throws std::runtime_error when no Verilated variant has all the ICs of `fitted`.
std::unique_ptr<Board> make_rtl_board(std::uint32_t fitted, const RtlOptions& options = {});

// Runs both and compares every pin at every tick. run_until() throws LockstepDifference at the first difference.
std::unique_ptr<Board> make_lockstep_board(std::unique_ptr<Board> rtl, std::unique_ptr<Board> model);

// The two engines disagree: what() names the tick, the simulated time, every differing signal with both values and the
// last bus accesses.
class LockstepDifference : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace brick
