// Who watches the lines of Port A: told each level that the CPU drives at the exact time at which it moves, and what
// the board drives at the edge that shows it. Besides levels it learns only what no pin says: the CPU clock, the
// programmed wait states and the program counter. Nobody watching costs nothing.
#pragma once

#include <cstdint>

#include "systemc/core/board_pins.h"
#include "systemc/core/ticks.h"

namespace brick {

struct PortALevels {  // the CPU's side of the bus
  std::uint32_t addr = 0;
  bool x = false;
  std::uint8_t aa = 0;
  bool addr_oe = false;  // A, X and AA are held; else what stands there is nobody's
  bool rd_n = true, wr_n = true;
  std::uint32_t data = 0;
  bool data_oe = false;

  // Of the access under way.
  unsigned multiplier = 8, wait_states = 0;  // I52 + 1; as programmed
  std::uint32_t pc = 0;                      // 0: not a program's

  bool same_address(const PortALevels& o) const {
    return addr == o.addr && x == o.x && aa == o.aa && addr_oe == o.addr_oe;
  }
  bool same_data(const PortALevels& o) const { return data == o.data && data_oe == o.data_oe; }
};

class PortAWatch {
 public:
  virtual ~PortAWatch() = default;
  virtual void cpu_moved(TimeFs time, const PortALevels& levels) = 0;
  virtual void board_moved(TimeFs time, const BoardOutputs& board) = 0;  // D, its enable or /TA
  virtual void bus_reset() = 0;                                          // a cycle under way is void
};

}  // namespace brick
