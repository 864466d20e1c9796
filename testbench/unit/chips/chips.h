// A board of separate chips: board_chip and a servo_ic_chip for each fitted servo IC, each Verilated by itself, joined
// by wires: Port A, PHASE and SERVO, reset, trip, EQU. An edge of the oscillator is one of every chip; what then leaves
// a pad is at the others' pads before the next edge (pad and wire up to 7 ns, a tick is 8.477 ns) or, as a fault,
// behind it. Two that drive a wire at different levels are reported, not resolved. docs/chips.md.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "systemc/core/board.h"

namespace brick {

// Negative controls: what can be wrong with a chip, or with the board around it.
enum class ChipFault {
  kNone,
  kWrongNumber,      // the number straps of servo IC 1 say 2
  kPhaseNeverTurns,  // the PHASE pin of servo IC 0 stays an input
  kServoNeverTurns,  // its SERVO pin
  kLateClocks,       // pad and wire of PHASE and SERVO take more than a tick
  kLateReset,        // that of the reset
  kNoTrip,           // servo IC 1 does not hear the watchdog
  kSwappedEqu,       // EQU of servo ICs 0 and 1
  kStrapLeft         // the board's chip takes every servo IC to be there
};

struct BoardChip;  // a Verilated module each
struct ServoIcChip;

class Chips {
 public:
  // Power-on is tick 0, in reset. `fitted`: servo ICs, and MACRO IC 0, which is inside the board's chip.
  Chips(std::uint32_t fitted, std::uint64_t seed, ChipFault fault = ChipFault::kNone);
  ~Chips();

  // As Board::set_inputs(). Bits of `fitted` change in reset only: an IC is pulled out with power off, or put back.
  void set_inputs(const BoardInputs& in);
  void set_motor_inputs(unsigned ic, const MotorInputs& in);
  void tick();
  Tick now() const { return now_; }

  // As Board: PHASE, SERVO, D and its enable are the wires. The chip's own phase_source and source_conflict.
  BoardOutputs outputs() const;
  BoardOutputs at_once();
  MotorOutputs motor_outputs(unsigned ic) const;  // pins alone, no counters
  bool has(unsigned ic) const { return (present_ >> ic & 1) != 0; }

  unsigned drivers_of_data() const { return drivers_; }
  bool driven_by_ic() const { return drivers_ != 0 && !driven_by_board_; }
  // What is in contention on PHASE, SERVO and D since the last call: wire, who drives it how, first tick.
  std::vector<std::string> take_contention();

 private:
  struct Wires {
    bool phase = true, servo = true, trip = false, rst_ref_n = false;
    std::uint8_t equ = 0;
  };
  Wires driven();
  bool apply(const Wires& wires);
  void join(Wires late);
  void join_data();
  void power_on();
  bool clock_wire(bool servo);
  void report(const std::string& wire, const std::string& drivers);

  std::unique_ptr<BoardChip> board_;
  std::vector<std::unique_ptr<ServoIcChip>> ics_;  // by index; none: not fitted
  const ChipFault fault_;
  std::uint32_t fitted_, present_ = 0;
  BoardInputs in_;
  Wires wires_;  // as they stand at the pads
  Wires last_;   // as they were driven after the edge before
  std::uint32_t data_ = 0;
  unsigned drivers_ = 0;
  bool driven_by_board_ = false;
  bool settled_ = true;
  std::vector<std::string> contention_, reported_;
  Tick now_ = 0;
};

}  // namespace brick
