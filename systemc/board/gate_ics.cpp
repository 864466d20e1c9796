#include "systemc/board/gate_ics.h"

#include <algorithm>
#include <string>

namespace brick {
namespace {

// Calls `f` with the number of each 1.
template <class F>
void for_each_bit(std::uint32_t bits, F f) {
  for (; bits != 0; bits &= bits - 1) f(static_cast<unsigned>(__builtin_ctz(bits)));
}

}  // namespace

GateIcs::GateIcs(std::uint32_t built) : built_(built & ((1u << kIcs) - 1)) {
  look_.fill(kNever);
  for_each_bit(built_, [this](unsigned ic) {
    if (ic < kServoIcs) {
      servo_ic_[ic] = std::make_unique<ServoIc>(("servo_ic" + std::to_string(ic)).c_str());
      servo_ic_[ic]->set_motor_inputs({});
      follower_[ic] = servo_ic_[ic].get();
    } else {
      macro_ic_[ic - kServoIcs] = std::make_unique<MacroIc>(("macro_ic" + std::to_string(ic - kServoIcs)).c_str());
      follower_[ic] = macro_ic_[ic - kServoIcs].get();
    }
    driver_[ic] = std::make_unique<ClockGen>(("driver" + std::to_string(ic)).c_str());
  });
}

void GateIcs::reset(Tick t) {
  history_.clear();
  phase_ = servo_ = true;
  trip_ = false;
  macro_gates_ = 0;
  for_each_bit(built_, [&](unsigned ic) {
    ClockFollower& follower = *follower_[ic];
    if (ic < kServoIcs) servo_ic_[ic]->set_trip(false);  // the watchdog is reset too
    follower.reset(t);
    follower.restart_history();
    follower.set_pins(true, true);
    if (ic < kServoIcs)
      look(ic, t);
    else
      macro_ic_[ic - kServoIcs]->set_gate(false);
    drive(ic);
  });
  show_drivers();
}

bool GateIcs::advance(Tick t) {
  if (next_look_ <= t) {
    for_each_bit((watched_ | interrupting_ics()) & built_, [&](unsigned ic) {
      if (look_[ic] > t) return;
      catch_up(ic, t);
      look(ic, t);
    });
  }
  if (next_clock_ > t) return false;
  for_each_bit(drives_, [&](unsigned ic) { driver_[ic]->advance(t); });
  show_drivers();
  return true;
}

std::uint32_t GateIcs::read(unsigned ic, bool x, std::uint32_t addr, Tick t) const {
  if (ic >= kServoIcs) return macro_ic_[ic - kServoIcs]->read(x, addr & 63);
  catch_up(ic, t);
  return servo_ic_[ic]->read(x, addr & 31);
}

void GateIcs::read_taken(unsigned ic, bool x, std::uint32_t addr, Tick t) {
  if (ic >= kServoIcs || !ServoChannels::read_acts(x, addr & 31)) return;
  catch_up(ic, t);
  servo_ic_[ic]->read_taken(x, addr & 31);
}

void GateIcs::write(unsigned ic, bool x, std::uint32_t addr, std::uint32_t value, Tick t) {
  catch_up(ic, t);
  if (ic < kServoIcs) {
    servo_ic_[ic]->write(x, addr & 31, value);
    look(ic, t);
  } else {
    macro_ic_[ic - kServoIcs]->write(x, addr & 63, value);
  }
  drive(ic);
  show_drivers();
}

void GateIcs::set_clocks(bool phase, bool servo, Tick now) {
  if (phase == phase_ && servo == servo_) return;
  const ClockHistory::Edge edge{now, phase, servo};
  if (history_.should_end(edge)) catch_up_all(now);
  history_.push(edge);
  phase_ = phase;
  servo_ = servo;
  for_each_bit(watched_, [&](unsigned ic) {
    catch_up(ic, now);
    look(ic, now);
  });
  for_each_bit(drives_, [&](unsigned ic) {
    driver_[ic]->advance(now);
    driver_[ic]->in.phase = phase;
    driver_[ic]->in.servo = servo;
  });
  show_drivers();
}

void GateIcs::set_trip(bool trip, Tick now) {
  if (trip == trip_) return;
  trip_ = trip;
  for_each_bit(built_ & ((1u << kServoIcs) - 1), [&](unsigned ic) {
    catch_up(ic, now);
    servo_ic_[ic]->set_trip(trip);
    look(ic, now);
  });
}

void GateIcs::set_interrupting(std::uint32_t equ, Tick now) {
  interrupting_ = equ;
  equ_ = 0;
  for_each_bit(3 & built_, [&](unsigned ic) {
    catch_up(ic, now);
    look(ic, now);
  });
}

void GateIcs::set_macro_gates(std::uint32_t gates, Tick now) {
  for_each_bit((gates ^ macro_gates_) & built_ >> kServoIcs, [&](unsigned i) {
    catch_up(kServoIcs + i, now);
    macro_ic_[i]->set_gate((gates >> i & 1) != 0);
    drive(kServoIcs + i);
  });
  macro_gates_ = gates;
  show_drivers();
}

void GateIcs::set_motor_inputs(unsigned ic, const MotorInputs& inputs, Tick now) {
  if (ic >= kServoIcs || !has(ic)) return;
  catch_up(ic, now);
  servo_ic_[ic]->set_motor_inputs(inputs);
  look(ic, now);
}

void GateIcs::send_adc(unsigned ic, const ConverterWords& words, Tick now) {
  if (ic >= kServoIcs || !has(ic)) return;
  catch_up(ic, now);
  servo_ic_[ic]->send_adc(words);  // no output shows it
}

MotorOutputs GateIcs::motor_outputs(unsigned ic, Tick now, const MotorOutputs& select) const {
  if (ic >= kServoIcs || !has(ic)) return {};
  catch_up(ic, now);
  return servo_ic_[ic]->motor_outputs(select);
}

void GateIcs::watch(unsigned ic, const MotorOutputs& select, Tick now) {
  if (!has(ic) || select == watched_outputs_[ic]) return;
  watched_outputs_[ic] = select;
  watched_ = (watched_ & ~(1u << ic)) | (select != MotorOutputs{} ? 1u : 0u) << ic;
  catch_up(ic, now);
  look(ic, now);
}

void GateIcs::catch_up_all(Tick t) {
  for_each_bit(built_, [&](unsigned ic) {
    catch_up(ic, t);
    follower_[ic]->restart_history();
  });
  history_.clear();
}

void GateIcs::look(unsigned ic, Tick now) {
  const ServoIc& servo_ic = *servo_ic_[ic];
  const std::uint32_t bit = 1u << ic;
  Tick next = kNever;
  if (const unsigned channels = interrupting(ic); channels != 0) {
    equ_ = (equ_ & ~(0xFu << 4 * ic)) | (servo_ic.equ() & channels) << 4 * ic;
    next = servo_ic.next_equ_event(channels);
  }
  if ((watched_ & bit) != 0) next = std::min(next, servo_ic.next_motor_event(watched_outputs_[ic]));
  looked_ |= bit;
  look_[ic] = std::max(next, now + 1);
  next_look_ = *std::min_element(look_.begin(), look_.end());
}

void GateIcs::drive(unsigned ic) {
  const ClockFollower& follower = *follower_[ic];
  const std::uint32_t bit = 1u << ic;
  drives_ = (drives_ & ~bit) | (follower.clock_gen().active() ? bit : 0);
  if ((drives_ & bit) != 0) driver_[ic]->take(follower.clock_gen());
}

void GateIcs::show_drivers() {
  next_clock_ = kNever;
  phase_levels_ = servo_levels_ = ~0u;
  drivers_.phase = drivers_.servo = 0;
  for_each_bit(drives_, [&](unsigned ic) {
    const ClockGen& driver = *driver_[ic];
    next_clock_ = std::min(next_clock_, driver.next_event());
    if (driver.phase_oe()) drivers_.phase |= 1u << ic;
    if (driver.servo_oe()) drivers_.servo |= 1u << ic;
    if (!driver.active()) drives_ &= ~(1u << ic);
    if (!driver.phase()) phase_levels_ &= ~(1u << ic);
    if (!driver.servo()) servo_levels_ &= ~(1u << ic);
  });
}

}  // namespace brick
