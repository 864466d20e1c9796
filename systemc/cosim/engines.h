// Makes a board for an engine. The Verilated headers stay behind this line.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "systemc/core/board.h"

namespace brick {

struct RtlOptions { std::uint64_t seed = 1; bool seeded_bug = false; };

std::unique_ptr<Board> make_rtl_board(std::uint32_t fitted, const RtlOptions& options = {});
std::unique_ptr<Board> make_model_board(std::uint32_t fitted);  // systemc/board/board_top.h, the SystemC model
std::unique_ptr<Board> make_lockstep_board(std::unique_ptr<Board> rtl, std::unique_ptr<Board> model);

// The two engines disagree: what() names the tick, the simulated time, every differing signal with both values and the
// last bus accesses.
class LockstepDifference : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace brick
