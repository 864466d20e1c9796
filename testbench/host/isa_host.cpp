#include "testbench/host/isa_host.h"

#include <algorithm>

#include <fmt/format.h>

namespace brick {

namespace {
constexpr Tick kHeartbeat = 1'000'000;       // ticks between two looks at the wall clock, 8.5 ms
constexpr std::uint16_t kIdleData = 0xFFFF;  // pull-ups of the data bus
}  // namespace

IsaHost::IsaHost(Machine& machine) : machine_(machine), width_(machine.inputs().slot8 ? 8 : 16) {}

// ---------------------------------------------------------------------------------------------------------------- time

void IsaHost::step_to(Tick limit, const BoardOutputs& stop_on) {
  if (!on_edge_) {
    machine_.run_until(limit, stop_on);
    return;
  }
  const BoardOutputs before = machine_.outputs();
  BoardOutputs stop = stop_on;
  for (unsigned i = 0; i < kBoardOutputWords; ++i) stop.w[i] |= watched_.w[i];
  machine_.run_until(limit, stop);
  if (before.differs(machine_.outputs(), watched_)) on_edge_(machine_.now(), before, machine_.outputs());
}

void IsaHost::advance_to(Tick tick) {
  for (Tick at = now(); at < tick; at = now()) {
    step_to(std::min(tick, at + kHeartbeat), {});
    if (heartbeat_) heartbeat_();
  }
}

void IsaHost::advance_to_stop(Tick limit) {
  step_to(std::min(limit, now() + kHeartbeat), {});
  if (heartbeat_) heartbeat_();
}

void IsaHost::wait_change(const PinField& pin, Tick limit) {
  const std::uint32_t value = machine_.outputs().get(pin);
  while (now() < limit && machine_.outputs().get(pin) == value) {
    step_to(std::min(limit, now() + kHeartbeat), select_pins(pin));
    if (heartbeat_) heartbeat_();
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
  free_at_ = std::max(free_at_, time);
  IsaPins moved = machine_.inputs();
  edit(moved);
  if (moved == machine_.inputs()) return;
  advance_to(fs_to_tick(time) - 1);
  edit(machine_.inputs());
  machine_.apply(time);
}

std::uint16_t IsaHost::data_bus() const {
  const std::uint32_t driven = machine_.outputs().get(pin::kIsaSdOe);
  const unsigned floats = ((driven & 1) != 0 ? 0u : 0x00FFu) | ((driven & 2) != 0 ? 0u : 0xFF00u);
  return static_cast<std::uint16_t>(machine_.outputs().get(pin::kIsaSd) | floats);
}

IsaHost::Result IsaHost::cycle(const Cycle& c) {
  const TimeFs start = cycle_start();
  const auto strobe = [&c](IsaPins& in, bool level) {
    bool IsaPins::*const pins[] = {&IsaPins::isa_ior_n, &IsaPins::isa_iow_n, &IsaPins::isa_memr_n,
                                   &IsaPins::isa_memw_n};
    in.*pins[static_cast<unsigned>(c.command)] = level;
  };
  Result result{0, false};
  isa::CycleTimes times = c.memory() ? (width_ == 8 ? times_.memory8 : times_.memory) : times_.io;
  const auto address = [&](IsaPins& in) {
    in.isa_sa = c.address & 0xFFFFF;
    in.isa_aen = false;
    in.isa_sbhe_n = !c.sbhe;
  };

  // The points up to the command, in the order of time.
  drive(start, [&](IsaPins& in) {
    in.isa_la = c.memory() ? static_cast<std::uint8_t>(c.address >> 17) : in.isa_la;
    if (times.address == 0) address(in);
  });
  bool data_driven = !c.write();
  const auto data = [&](TimeFs until) {
    if (data_driven || times.data_valid > until) return;
    drive(start + times.data_valid, [&](IsaPins& in) { in.isa_sd = c.data; });
    data_driven = true;
  };
  data(times.address);
  if (times.address != 0) drive(start + times.address, address);
  data(isa::kMemcs16);
  if (c.memory() && width_ == 16) {
    advance_to(fs_to_tick_floor(start + isa::kMemcs16));
    result.narrow = pins().get(pin::kIsaMemcs16N) != 0;
    if (result.narrow) times = times_.memory8;
  }
  data(times.command_low);
  drive(start + times.command_low, [&](IsaPins& in) { strobe(in, false); });
  data(times.command_high);

  const TimeFs low = start + times.command_low, high = start + times.command_high;
  const TimeFs end = not_ready(times, high) ? stretch(c, start, low, high) : high;
  advance_to(fs_to_tick_floor(end - times.sample));
  result.data = data_bus();
  drive(end, [&](IsaPins& in) { strobe(in, true); });
  const TimeFs release = end + (times.release - times.command_high);
  drive(release, [](IsaPins& in) {
    in.isa_sd = kIdleData;
    in.isa_sbhe_n = true;
  });
  advance_to(fs_to_tick(release) - 1);
  free_at_ = end + (times.next - times.command_high);
  return result;
}

// Whether IOCHRDY falls before it is looked at for the first time. If not, all stand until the sample: one advance.
bool IsaHost::not_ready(const isa::CycleTimes& times, TimeFs end) {
  if (pins().get(pin::kIsaIochrdy) == 0) return true;
  wait_change(pin::kIsaIochrdy, fs_to_tick_floor(end - times.sample));
  return pins().get(pin::kIsaIochrdy) == 0 && now() <= fs_to_tick_floor(end - isa::kReadyToHigh);
}

// IOCHRDY is looked at one BCLK before the command would end, and again at each BCLK.
TimeFs IsaHost::stretch(const Cycle& c, TimeFs start, TimeFs low, TimeFs end) {
  advance_to(fs_to_tick_floor(end - isa::kReadyToHigh));
  while (pins().get(pin::kIsaIochrdy) == 0) {
    if (end - start > isa::kLongestStretch)
      throw HostBusError(
          fmt::format("host bus: IOCHRDY stays low in the {} cycle at {}{:X}; expected: high within 15.6 us (t10)",
                      c.write() ? "write" : "read", c.memory() ? "memory address 0x" : "I/O address 0x", c.address));
    if (times_.exact_ready) {
      wait_change(pin::kIsaIochrdy, fs_to_tick(low + isa::kLongestStretch));
      end = machine_.now_fs() + isa::kReadyToHigh;
    } else {
      end += isa::kBclk;
      advance_to(fs_to_tick_floor(end - isa::kReadyToHigh));
    }
  }
  return end;
}

std::uint8_t IsaHost::cycle8(Command command, std::uint32_t address, std::uint8_t data) {
  return cycle({command, address, static_cast<std::uint16_t>(0xFF00 | data), false}).data & 0xFF;
}

std::uint8_t IsaHost::read_io(std::uint32_t port) { return cycle8(Command::kIoRead, port, 0xFF); }
void IsaHost::write_io(std::uint32_t port, std::uint8_t value) { cycle8(Command::kIoWrite, port, value); }

std::uint16_t IsaHost::read_memory(std::uint32_t address, unsigned lanes) {
  if (width_ == 16) {
    const Result wide = cycle({Command::kMemoryRead, address + ((lanes & 1) != 0 ? 0 : 1), 0xFFFF, (lanes & 2) != 0});
    if (!wide.narrow) return wide.data;
  }
  const unsigned low = (lanes & 1) != 0 ? cycle8(Command::kMemoryRead, address, 0xFF) : 0xFFu;
  const unsigned high = (lanes & 2) != 0 ? cycle8(Command::kMemoryRead, address + 1, 0xFF) : 0xFFu;
  return static_cast<std::uint16_t>(high << 8 | low);
}

void IsaHost::write_memory(std::uint32_t address, std::uint16_t value, unsigned lanes) {
  if (width_ == 16 &&
      !cycle({Command::kMemoryWrite, address + ((lanes & 1) != 0 ? 0 : 1), value, (lanes & 2) != 0}).narrow)
    return;
  if ((lanes & 1) != 0) cycle8(Command::kMemoryWrite, address, static_cast<std::uint8_t>(value));
  if ((lanes & 2) != 0) cycle8(Command::kMemoryWrite, address + 1, static_cast<std::uint8_t>(value >> 8));
}

}  // namespace brick
