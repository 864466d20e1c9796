// The servo and MACRO ICs of the board and how far each of them has been executed. An IC that nobody looks at stays
// behind; it is brought up to date when a register of it is accessed, its inputs change or its outputs are asked for.
// What the board cannot wait for has a time of its own: the clock chain of an IC that drives PHASE or SERVO runs ahead
// as a second one (`driver`), and an IC with an output that is waited for says when to look again (`look_`).
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "systemc/board/clock_select.h"
#include "systemc/core/motor_pins.h"
#include "systemc/macro_ic/macro_ic.h"
#include "systemc/servo_ic/clock_history.h"
#include "systemc/servo_ic/servo_ic.h"

namespace brick {

class GateIcs {
 public:
  static constexpr unsigned kServoIcs = kMaxServoIcs, kMacroIcs = 4, kIcs = kServoIcs + kMacroIcs;

  explicit GateIcs(std::uint32_t built);

  std::uint32_t built() const { return built_; }
  ServoIc* servo_ic(unsigned index, Tick now) const {
    return index < kServoIcs && has(index) ? (catch_up(index, now), servo_ic_[index].get()) : nullptr;
  }
  MacroIc* macro_ic(unsigned index, Tick now) const {
    return index < kMacroIcs && has(kServoIcs + index) ? (catch_up(kServoIcs + index, now), macro_ic_[index].get())
                                                       : nullptr;
  }

  void reset(Tick t);
  void end(Tick now) { catch_up_all(now); }  // a reset comes: what the ICs have done up to now is told

  // What the board's pins or an interrupt line show can change at this tick at the earliest.
  Tick next_event() const { return next_clock_ < next_look_ ? next_clock_ : next_look_; }
  Tick next_clock_event() const { return next_clock_; }  // PHASE and SERVO pins only
  // Executes the edges of what may have such a change by t. Returns true when a clock pin may have changed.
  bool advance(Tick t);

  // Registers; `ic` as in BoardInputs::fitted. The edges up to t have been executed with the inputs as they were set.
  std::uint32_t read(unsigned ic, bool x, std::uint32_t addr, Tick t) const;
  void read_taken(unsigned ic, bool x, std::uint32_t addr, Tick t);
  void write(unsigned ic, bool x, std::uint32_t addr, std::uint32_t value, Tick t);

  // Inputs, for the edges after `now`.
  void set_clocks(bool phase, bool servo, Tick now);
  void set_trip(bool trip, Tick now);
  void set_macro_gates(std::uint32_t gates, Tick now);
  void set_motor_inputs(unsigned ic, const MotorInputs& inputs, Tick now);

  // Outputs after the edge `now`.
  const ClockSelect::Drivers& drivers() const { return drivers_; }
  std::uint32_t phase_levels() const { return phase_levels_; }
  std::uint32_t servo_levels() const { return servo_levels_; }
  // Of the eight EQU outputs that can interrupt, bits 3..0 servo IC 0, 7..4 servo IC 1, those that do.
  std::uint32_t equ() const { return equ_; }
  void set_interrupting(std::uint32_t equ, Tick now);
  MotorOutputs motor_outputs(unsigned ic, Tick now, const MotorOutputs& select = kAllMotorOutputs) const;
  void watch(unsigned ic, const MotorOutputs& select, Tick now);
  // The serial streams of a servo IC, as MotorDigest; nullptr: it is not built.
  const ServoChannels* channels(unsigned ic, Tick now) const {
    return ic < kServoIcs && has(ic) ? (catch_up(ic, now), &servo_ic_[ic]->channels()) : nullptr;
  }
  void send_adc(unsigned ic, const ConverterWords& words, Tick now);
  // Watched ICs whose outputs may have changed since the last call.
  std::uint32_t take_changes() {
    const std::uint32_t ics = looked_ & watched_;
    looked_ = 0;
    return ics;
  }

 private:
  friend class BoardWaker;
  friend class BoardProbe;

  // Channels of servo IC 0 and 1 whose EQU interrupts.
  unsigned interrupting(unsigned ic) const { return ic < 2 ? interrupting_ >> 4 * ic & 0xF : 0; }
  std::uint32_t interrupting_ics() const {
    return ((interrupting_ & 0xF) != 0 ? 1u : 0u) | ((interrupting_ & 0xF0) != 0 ? 2u : 0u);
  }

  bool has(unsigned ic) const { return (built_ >> ic & 1) != 0; }
  void catch_up(unsigned ic, Tick t) const { follower_[ic]->catch_up(history_, t); }
  void catch_up_all(Tick t);
  void look(unsigned ic, Tick now);  // after it has caught up: what it shows, and when to look again
  void drive(unsigned ic);           // after it has caught up: whether it drives the clocks
  void show_drivers();

  std::uint32_t built_;
  std::array<std::unique_ptr<ServoIc>, kServoIcs> servo_ic_;
  std::array<std::unique_ptr<MacroIc>, kMacroIcs> macro_ic_;
  std::array<ClockFollower*, kIcs> follower_{};
  std::array<std::unique_ptr<ClockGen>, kIcs> driver_;
  ClockHistory history_;
  bool phase_{}, servo_{}, trip_{};
  std::uint32_t macro_gates_{};

  ClockSelect::Drivers drivers_;
  std::uint32_t drives_ = 0;  // ICs that drive PHASE or SERVO
  std::uint32_t phase_levels_{}, servo_levels_{};
  std::uint32_t watched_ = 0, looked_ = 0, equ_ = 0, interrupting_ = 0;
  std::array<MotorOutputs, kServoIcs> watched_outputs_{};
  std::array<Tick, kServoIcs> look_{};
  Tick next_clock_ = kNever, next_look_ = kNever;
};

}  // namespace brick
