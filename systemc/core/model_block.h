// One clocked block of the SystemC model, as the board drives it (systemc/board/board_top.cpp). The rules make every
// block behave as its RTL twin does with nonblocking assignments:
//  - Inputs are plain fields or setters named as the RTL ports without _i. They are levels: every edge after the last
//    executed one sees them, until the board changes them. A strobe (`we`, `hp_wr`, `rd_done`, ...) is a level too: the
//    board sets it after edge n and takes it away after edge n+1, so exactly the edge n+1 (clk_ref) sees it.
//  - Outputs are functions named as the RTL ports without _o: the state after the last executed edge (a combinational
//    output, such as a read multiplexer, follows the inputs as they stand).
//  - At an event t the board calls advance(t) of the blocks whose next_event() it is, then copies the wires that they
//    feed, then asks them and those they feed for next_event() anew. A block may stay behind until then; before an
//    input of it changes, advance(t) lets it execute what has passed. So edge t sees what the others showed before t,
//    whatever the order of the calls.
//  - An IC (systemc/servo_ic/clock_follower.h) may stay behind: before an input of it changes or anything about it is
//  asked,
//    its owner executes the edges that it has missed, with the inputs as they were.
#pragma once

#include "systemc/core/ticks.h"

namespace brick {

// First rising edge of clk_ref after tick t.
constexpr Tick next_ref_edge(Tick t) { return (t / kTicksPerRef + 1) * kTicksPerRef; }
constexpr bool is_ref_edge(Tick t) { return t % kTicksPerRef == 0; }

class ModelBlock {
 public:
  virtual ~ModelBlock() = default;

  // First tick after the last executed edge at which anything outside the block can see a change, as long as its inputs
  // stay as they are; kNever when there is none. Too early costs time only, too late is wrong.
  virtual Tick next_event() const = 0;

  // Executes the edges up to and including t. The board never passes next_event(): t <= next_event().
  virtual void advance(Tick t) = 0;

  // Asynchronous reset: all registers at their reset values, all edges up to and including t spent in reset. Called
  // before anything else, and again with later t for as long as rst_n is low; the first edge executed normally is
  // t + 1. Memory keeps its content.
  virtual void reset(Tick t) = 0;
};

}  // namespace brick
