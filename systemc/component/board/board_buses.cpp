#include "systemc/component/board/board_buses.h"

#include <algorithm>

namespace brick::component {

BoardBuses::BoardBuses(brick::Board& board) : board_(board) { reset_port_a(); }

void BoardBuses::set_inputs(const BoardInputs& inputs) {
  const BoardInputs before = pins_;
  pins_ = inputs;
  if (buses_[kPortAFace].used) static_cast<PortAPins&>(pins_) = before;
  if (buses_[kIsaFace].used) {
    static_cast<IsaPins&>(pins_) = before;
    pins_.isa_resetdrv = inputs.isa_resetdrv;  // no line of a cycle
  }
  if (pins_.rst_n != before.rst_n) reset_port_a();
  board_.set_inputs(pins_);
}

// The line resets the bus master too, as it does the CPU that has one: the clock starts anew as it is let go.
void BoardBuses::reset_port_a() {
  PortAPins nobody;
  const bool broken = port_a_.running();
  port_a_.reset(board_.now(), 0, buses_[kPortAFace].used ? pins_ : nobody);
  if (broken) finish(kPortAFace, 0, {tick_to_fs(board_.now()), false});
  ended_ = false;
}

void BoardBuses::begin(unsigned face, const Cycle& cycle) {
  buses_[face].busy = true;
  buses_[face].waiting = cycle;
  start(face);
  ended_ = false;
}

void BoardBuses::abandon(unsigned face) {
  buses_[face].busy = false;
  buses_[face].waiting.reset();
}

void BoardBuses::start(unsigned face) {
  Bus& bus = buses_[face];
  if (!bus.waiting || (face == kPortAFace ? port_a_.running() : isa_.running())) return;
  const Cycle cycle = *bus.waiting;
  bus.waiting.reset();
  bus.used = true;
  face == kPortAFace ? start_port_a(cycle) : start_isa(cycle);
}

void BoardBuses::start_port_a(const Cycle& cycle) {
  if (!pins_.rst_n) return finish(kPortAFace, 0, {tick_to_fs(board_.now()), false});
  board_.on_change = [this](Tick t, const BoardOutputs&, const BoardOutputs& after) {
    port_a_.board_changed(t, after);
  };
  // The first clock after the call; the one that begins with power-on no edge would see.
  const CpuClock& clock = port_a_.clock();
  std::int64_t start = std::max(port_a_.free_at(), clock.first_cycle(fs_to_tick_floor(cycle.asked)));
  while (clock.time(start) < cycle.asked || fs_to_tick(clock.time(start)) <= board_.now()) ++start;
  port_a_.begin({cycle.address / 8, (cycle.address & 4) != 0, cycle.write, cycle.value, start, 0});
  step_port_a();
}

void BoardBuses::step_port_a() {
  while (port_a_.running() && port_a_.stands_at() <= board_.now()) {
    port_a_.step(pins_, board_.outputs());
    board_.set_port_a(pins_);
    if (port_a_.strobe_moved()) port_a_.board_follows(board_.port_a_at_once());
  }
  if (!port_a_.done()) return;
  port_a_.take_answer();
  const PortACycle& cycle = port_a_.answer();
  const bool no_cycle = cycle.end == 0;  // BCR, PCTL
  finish(kPortAFace, cycle.data, {no_cycle ? port_a_.clock().time(port_a_.done_at()) : cycle.end, true});
}

void BoardBuses::start_isa(const Cycle& cycle) {
  const bool memory = (cycle.address & kIsaMemory) != 0;
  const IsaCommand command = memory        ? cycle.write ? IsaCommand::kMemoryWrite : IsaCommand::kMemoryRead
                             : cycle.write ? IsaCommand::kIoWrite
                                           : IsaCommand::kIoRead;
  const isa::HostTimes& times = isa::kTypical;
  const TimeFs earliest = std::max({isa_free_, cycle.asked, tick_to_fs(board_.now()) + 1});
  isa_.begin(
      {command, cycle.address & (kIsaMemory - 1), static_cast<std::uint16_t>(cycle.value), (cycle.lanes & 2) != 0},
      (earliest + times.grid - 1) / times.grid * times.grid, times, pins_.slot8 ? 8 : 16);
  step_isa();
}

void BoardBuses::step_isa() {
  if (!isa_.running()) return;
  while (isa_.running()) {
    if (!isa_.drives()) {
      if (board_.now() < isa_.tick() && !isa_.stands(board_.outputs())) return;
      isa_.look(board_.now(), board_.outputs());
      continue;
    }
    if (isa_stand() > board_.now()) return;
    const IsaPins before = pins_;
    isa_.drive(pins_);
    if (!(before == pins_)) board_.set_inputs(pins_);
    isa_.driven();
  }
  isa_free_ = isa_.free_at();
  const IsaResult& result = isa_.result();
  finish(kIsaFace, result.data | (result.narrow ? kIsaNarrow : 0), {isa_.end(), !result.stuck});
}

void BoardBuses::finish(unsigned face, std::uint32_t value, Chip::BusEnd end) {
  Bus& bus = buses_[face];
  if (bus.busy && !bus.waiting) {
    bus.busy = false;
    bus.value = value;
    bus.end = end;
    ended_ = true;
  }
  start(face);
}

Tick BoardBuses::isa_stand() const {
  return std::max(board_.now(), isa_.drives() ? fs_to_tick(isa_.time()) - 1 : isa_.tick());
}

Tick BoardBuses::next() const {
  return std::min(port_a_.running() ? port_a_.stands_at() : kNever, isa_.running() ? isa_stand() : kNever);
}

BoardOutputs BoardBuses::stops() const {
  static constexpr BoardOutputs kReady = select_pins(pin::kIsaIochrdy);
  return isa_.running() && !isa_.drives() && isa_.waits() ? kReady : BoardOutputs{};
}

bool BoardBuses::step() {
  step_port_a();
  step_isa();
  const bool ended = ended_;
  ended_ = false;
  return ended;
}

}  // namespace brick::component
