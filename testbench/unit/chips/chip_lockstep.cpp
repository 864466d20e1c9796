#include "testbench/unit/chips/chip_lockstep.h"

#include <fmt/format.h>

#include "systemc/cosim/engines.h"

namespace brick {

ChipLockstep::ChipLockstep(std::unique_ptr<Board> board, std::uint32_t fitted, std::uint64_t seed, ChipFault fault)
    : board_(std::move(board)), chips_(fitted, seed, fault) {
  board_->on_change = [this](Tick t, const BoardOutputs& before, const BoardOutputs& after) {
    if (on_change) on_change(t, before, after);
  };
  board_->on_motor_change = [this](Tick t, unsigned ic, const MotorOutputs& before, const MotorOutputs& after) {
    stopped_ |= before.differs(after, stop_[ic]);
    if (on_motor_change) on_motor_change(t, ic, before, after);
  };
  in_.fitted = fitted;
}

void ChipLockstep::set_inputs(const BoardInputs& inputs) {
  BoardInputs in = inputs;
  filter(in);
  if (in.pa_rd_n && !in_.pa_rd_n && outputs().get(pin::kPaDataOe) != 0) {
    ++counts_.reads;
    counts_.reads_by_ics += chips_.driven_by_ic();
  }
  in_ = in;
  board_->set_inputs(in);
  chips_.set_inputs(in);
}

void ChipLockstep::set_motor_inputs(unsigned ic, const MotorInputs& inputs) {
  board_->set_motor_inputs(ic, inputs);
  chips_.set_motor_inputs(ic, inputs);
}

BoardOutputs ChipLockstep::port_a_at_once() const {
  const BoardOutputs one = board_->port_a_at_once();
  BoardOutputs mine = one;
  const BoardOutputs chips = chips_.at_once();
  for (const PinField& f : {pin::kPaData, pin::kPaDataOe, pin::kPaTaN}) mine.set(f, chips.get(f));
  compare(one, mine);
  return one;
}

Tick ChipLockstep::run_until(Tick limit, const BoardOutputs& stop_on) {
  stopped_ = false;
  while (now() < limit && !stopped_) {
    const BoardOutputs before = board_->outputs();
    const Tick at = now();
    board_->run_until(at + 1, {});
    chips_.tick();
    ++counts_.ticks;
    counts_.shared += chips_.drivers_of_data() > 1;
    compare(board_->outputs(), chips_.outputs());
    stopped_ |= before.differs(board_->outputs(), stop_on);
  }
  return now();
}

namespace {

constexpr BoardOutputs compared(bool data) {
  BoardOutputs all;
  for (std::uint32_t& w : all.w) w = ~0u;
  all.set(pin::kPhaseSource, 0);
  all.set(pin::kSourceConflict, 0);
  if (!data) all.set(pin::kPaData, 0);
  return all;
}

MotorOutputs pins_alone(const MotorOutputs& m) { return m & MotorOutputs{{~0u, ~0u}}; }

std::string line(const std::string& name, std::uint32_t one, std::uint32_t chips) {
  return one == chips ? "" : fmt::format("\n  {}: board_top ${:X}, chips ${:X}", name, one, chips);
}

}  // namespace

void ChipLockstep::compare(const BoardOutputs& one, const BoardOutputs& chips) const {
  static constexpr BoardOutputs kWithData = compared(true), kWithout = compared(false);
  const bool data = one.get(pin::kPaDataOe) != 0 && chips_.drivers_of_data() < 2;
  const BoardOutputs& select = data ? kWithData : kWithout;
  bool equal = !one.differs(chips, select);
  for (unsigned ic = 0; ic < kMaxServoIcs; ++ic)
    equal = equal && (!chips_.has(ic) || pins_alone(board_->motor_outputs(ic)) == chips_.motor_outputs(ic));
  if (equal) return;
  std::string text;
  for (const PinField& f : pin::kAll)
    if (select.get(f) != 0) text += line(std::string(f.name), one.get(f), chips.get(f));
  for (unsigned ic = 0; ic < kMaxServoIcs; ++ic) {
    if (!chips_.has(ic)) continue;
    const MotorOutputs a = pins_alone(board_->motor_outputs(ic)), b = chips_.motor_outputs(ic);
    for (const MotorField& f : motor_pin::kAll)
      for (unsigned n = 0; n < kChannels; ++n)
        text += line(fmt::format("{}.ch{}.{}", servo_ic_scope(ic), n + 1, f.name), a.get(f, n), b.get(f, n));
  }
  throw LockstepDifference(fmt::format("board_top and the board of chips differ at tick {}{}", now(), text));
}

}  // namespace brick
