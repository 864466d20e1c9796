#include "testbench/host/isa_host.h"

#include <algorithm>

#include <fmt/format.h>

namespace brick {

namespace {
constexpr Tick kHeartbeat = 1'000'000;  // ticks between two looks at the wall clock, 8.5 ms
}  // namespace

IsaHost::IsaHost(Machine& machine) : machine_(machine), width_(machine.inputs().slot8 ? 8 : 16) {}

// ---------------------------------------------------------------------------------------------------------------- time

void IsaHost::step_to(Tick limit, const BoardOutputs& stop_on) {
  const BoardOutputs before = machine_.outputs();
  BoardOutputs stop = stop_on;
  for (unsigned i = 0; i < kBoardOutputWords; ++i) stop.w[i] |= watched_.w[i];
  machine_.run_until(limit, stop);
  if (before.differs(machine_.outputs(), watched_)) on_edge_(machine_.now(), before, machine_.outputs());
}

// What the heartbeat throws must not leave a strobe low: within a cycle it waits for the end.
void IsaHost::beat() const {
  if (!isa_.running()) heartbeat();
}

void IsaHost::advance_to(Tick tick) {
  for (Tick at = now(); at < tick; at = now()) {
    step_to(std::min(tick, at + kHeartbeat), {});
    beat();
  }
}

void IsaHost::advance_to_stop(Tick limit) {
  step_to(std::min(limit, now() + kHeartbeat), {});
  heartbeat();
}

void IsaHost::wait_change(const PinField& pin, Tick limit) {
  const std::uint32_t value = machine_.outputs().get(pin);
  while (now() < limit && machine_.outputs().get(pin) == value) {
    step_to(std::min(limit, now() + kHeartbeat), select_pins(pin));
    beat();
  }
}

bool IsaHost::wait_pin(const PinField& pin, std::uint32_t value, Tick timeout) {
  const Tick limit = now() + timeout;
  while (machine_.outputs().get(pin) != value) {
    if (now() >= limit) return false;
    wait_change(pin, limit);
  }
  return true;
}

void IsaHost::watch(const BoardOutputs& pins, EdgeHook on_edge) {
  watched_ = pins;
  on_edge_ = std::move(on_edge);
}

// -------------------------------------------------------------------------------------------------------------- cycles

// First point of the grid from now on, after the pause that the host's own program makes.
TimeFs IsaHost::cycle_start() {
  const TimeFs earliest = std::max(free_at_, machine_.now_fs() + 1);
  TimeFs start = (earliest + times_.grid - 1) / times_.grid * times_.grid;
  if (pace_) start += pace_() * times_.grid;
  return start;
}

void IsaHost::drive_at(TimeFs time, const std::function<void(HostInputs&)>& edit) {
  Aperture& aperture = machine_.aperture();
  advance_to(aperture.first(time) - 1);  // that edge may be the first to see the change
  HostInputs& pins = machine_.inputs();
  const HostInputs before = pins;
  edit(pins);
  if (aperture.in_doubt(time) && aperture.last(time) - 1 > now()) {
    const HostInputs after = pins;
    static_cast<IsaPins&>(pins) = aperture.mixed<IsaPins>(before, after, time);
    machine_.apply_partly();
    advance_to(aperture.last(time) - 1);
    pins = after;
  }
  machine_.apply(time);
  free_at_ = std::max(free_at_, time);
}

// The same for a point of a cycle; pins that stay are nothing to stop for.
template <class Edit>
void IsaHost::drive(TimeFs time, const Edit& edit) {
  if (machine_.aperture().on()) return drive_at(time, edit);
  IsaPins moved = machine_.inputs();
  edit(moved);
  if (moved == machine_.inputs()) return;
  advance_to(fs_to_tick(time) - 1);
  edit(machine_.inputs());
  machine_.apply(time);
}

IsaResult IsaHost::cycle(const IsaCycle& c) {
  isa_.begin(c, cycle_start(), times_, width_);
  while (isa_.running()) {
    if (isa_.drives()) {
      drive(isa_.time(), [this](IsaPins& in) { isa_.drive(in); });
      isa_.driven();
      continue;
    }
    if (!isa_.waits())
      advance_to(isa_.tick());
    else if (!isa_.stands(pins()))
      wait_change(pin::kIsaIochrdy, isa_.tick());
    isa_.look(now(), pins());
    if (isa_.result().stuck)
      throw HostBusError(
          fmt::format("host bus: IOCHRDY stays low in the {} cycle at {}{:X}; expected: high within 15.6 us (t10)",
                      c.write() ? "write" : "read", c.memory() ? "memory address 0x" : "I/O address 0x", c.address));
  }
  free_at_ = isa_.free_at();
  beat();
  return isa_.result();
}

}  // namespace brick
