// The face of the controller board: every engine stands behind it (rtl, systemc, lockstep), chosen at run time.
// Whoever owns the board advances it; see docs/architecture.md, "Who may run ahead of whom".
#pragma once

#include <functional>
#include <optional>

#include "systemc/core/board_pins.h"
#include "systemc/core/motor_digest.h"
#include "systemc/core/motor_pins.h"
#include "systemc/core/ticks.h"

namespace brick {

class Board {
 public:
  virtual ~Board() = default;

  // Clock edges executed so far. Tick 0 is power-on; clk_ref rises at ticks 3, 6, 9, ...
  virtual Tick now() const = 0;

  // Applies inputs: the clock edge now()+1 is the first to see them. Outputs do not change by this call.
  virtual void set_inputs(const BoardInputs& inputs) = 0;
  // The same when no others than those of Port A have changed.
  virtual void set_port_a(const BoardInputs& inputs) { set_inputs(inputs); }

  // Outputs as they stand after the edge now().
  virtual const BoardOutputs& outputs() const = 0;

  // The same between edges, after set_inputs(): D, its enable and /TA as they follow the pins of Port A without a
  // clock; outputs() has that with the next edge. Who does not say is taken to have flip-flops there.
  virtual BoardOutputs port_a_at_once() const { return outputs(); }

  // Executes edges up to and including `limit`, or up to and including the first edge at which an output selected by
  // `stop_on` changes. Returns now().
  virtual Tick run_until(Tick limit, const BoardOutputs& stop_on = {}) = 0;

  // A tick up to which (inclusive) no pin selected by `watched` can change as long as the inputs stay as they are.
  // now() is always a correct answer; an engine that can predict gives a later one. Only speed depends on it.
  virtual Tick quiet_until(const BoardOutputs& watched) const {
    (void)watched;
    return now();
  }

  // What the dual-ported RAM holds at host byte offset 2 * index, for reports; none: this engine cannot say.
  virtual std::optional<std::uint16_t> dpram_word(unsigned index) const {
    (void)index;
    return {};
  }

  // Called after each edge at which an output changed, in order of ticks, with the values before and after.
  std::function<void(Tick, const BoardOutputs& before, const BoardOutputs& after)> on_change;

  // Motor side of servo IC `ic` (0..17); an IC that is not built ignores its inputs and shows zeros. Inputs as
  // set_inputs(); outputs as they stand after the edge now(). A board made of clocks alone may leave all this out.
  virtual void set_motor_inputs(unsigned ic, const MotorInputs& inputs) { (void)ic, (void)inputs; }
  virtual MotorOutputs motor_outputs(unsigned ic) const {
    (void)ic;
    return {};
  }

  // Changes of the selected motor outputs of servo IC `ic` are reported to on_motor_change, edge by edge, after
  // on_change of the same edge, rising index first; the others read 0 there. What nobody watches costs an event-driven
  // engine nothing.
  virtual void watch_motor(unsigned ic, const MotorOutputs& select) { (void)ic, (void)select; }
  // All outputs of the servo ICs whose bit is 1, none of the others.
  void watch_motors(std::uint32_t ics) {
    for (unsigned ic = 0; ic < kMaxServoIcs; ++ic)
      watch_motor(ic, (ics >> ic & 1) != 0 ? kAllMotorOutputs : MotorOutputs{});
  }
  // run_until() also ends after an edge at which an output selected here changes; it must be watched.
  virtual void stop_on_motor(unsigned ic, const MotorOutputs& select) { (void)ic, (void)select; }
  // Of the motor side, or nullptr: this engine has pins alone.
  virtual MotorDigest* motor_digest() { return nullptr; }
  std::function<void(Tick, unsigned ic, const MotorOutputs& before, const MotorOutputs& after)> on_motor_change;
};

}  // namespace brick
