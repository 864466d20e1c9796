#include "testbench/host/host_bus.h"

#include <algorithm>

#include <fmt/format.h>

namespace brick {

namespace {
constexpr Tick kHeartbeat = 1'000'000;       // ticks between two looks at the wall clock, 8.5 ms
constexpr std::uint16_t kIdleData = 0xFFFF;  // pull-ups of the data bus
}  // namespace

// ---------------------------------------------------------------------------------------------------------------- time

void HostBus::step_to(Tick limit, const BoardOutputs& stop_on) {
  const BoardOutputs before = machine_.outputs();
  BoardOutputs stop = stop_on;
  for (unsigned i = 0; i < kBoardOutputWords; ++i) stop.w[i] |= watched_.w[i];
  machine_.run_until(limit, stop);
  if (on_edge_ && before.differs(machine_.outputs(), watched_)) on_edge_(machine_.now(), before, machine_.outputs());
}

void HostBus::advance_to(Tick tick) {
  while (now() < tick) {
    step_to(std::min(tick, now() + kHeartbeat), {});
    if (heartbeat_) heartbeat_();
  }
}

void HostBus::advance_to_stop(Tick limit) {
  step_to(std::min(limit, now() + kHeartbeat), {});
  if (heartbeat_) heartbeat_();
}

void HostBus::wait_change(const PinField& pin, Tick limit) {
  const std::uint32_t value = machine_.outputs().get(pin);
  while (now() < limit && machine_.outputs().get(pin) == value) {
    step_to(std::min(limit, now() + kHeartbeat), select_pins(pin));
    if (heartbeat_) heartbeat_();
  }
}

bool HostBus::wait_pin(const PinField& pin, std::uint32_t value, Tick timeout) {
  const Tick limit = now() + timeout;
  while (machine_.outputs().get(pin) != value) {
    if (now() >= limit) return false;
    wait_change(pin, limit);
  }
  return true;
}

void HostBus::watch(const BoardOutputs& pins, EdgeHook on_edge) {
  watched_ = pins;
  on_edge_ = std::move(on_edge);
}

// ---------------------------------------------------------------------------------------------------------- bus cycles

// First BCLK edge from now on, after the pause that the host's own program makes.
TimeFs HostBus::cycle_start() {
  const TimeFs earliest = std::max(free_at_, machine_.now_fs() + 1);
  TimeFs start = (earliest + isa::kBclk - 1) / isa::kBclk * isa::kBclk;
  if (pace_) start += pace_() * isa::kBclk;
  return start;
}

void HostBus::drive_at(TimeFs time, const std::function<void(HostInputs&)>& edit) {
  Aperture& aperture = machine_.aperture();
  advance_to(aperture.first(time) - 1);  // that edge may be the first to see the change
  HostInputs& pins = machine_.inputs();
  const HostInputs before = pins;
  edit(pins);
  if (aperture.in_doubt(time) && aperture.last(time) - 1 > now()) {
    const HostInputs after = pins;
    static_cast<IsaPins&>(pins) = aperture.mixed<IsaPins>(before, after, time);
    machine_.apply();
    advance_to(aperture.last(time) - 1);
    pins = after;
  }
  machine_.apply();
}

std::uint16_t HostBus::cycle(Command command, std::uint32_t address, std::uint16_t data) {
  const bool memory = command == Command::kMemoryRead || command == Command::kMemoryWrite;
  const bool write = command == Command::kIoWrite || command == Command::kMemoryWrite;
  const isa::CycleTimes& times = memory ? isa::kMemory : isa::kIo;
  const TimeFs start = cycle_start();
  const auto strobe = [command](HostInputs& in, bool level) {
    switch (command) {
      case Command::kIoRead:
        in.isa_ior_n = level;
        break;
      case Command::kIoWrite:
        in.isa_iow_n = level;
        break;
      case Command::kMemoryRead:
        in.isa_memr_n = level;
        break;
      case Command::kMemoryWrite:
        in.isa_memw_n = level;
        break;
    }
  };

  drive_at(start, [&](HostInputs& in) {
    in.isa_sa = address;
    in.isa_aen = false;
    in.isa_sbhe_n = !memory;
  });
  if (write) drive_at(start + times.data_valid, [&](HostInputs& in) { in.isa_sd = data; });
  drive_at(start + times.command_low, [&](HostInputs& in) { strobe(in, false); });

  TimeFs end = start + times.command_high;
  for (;;) {  // IOCHRDY is looked at one BCLK before the command would end, and again at each BCLK
    advance_to(fs_to_tick_floor(end - isa::kReadyToHigh));
    if (machine_.outputs().get(pin::kIsaIochrdy)) break;
    end += isa::kBclk;
    if (end - start > isa::kLongestStretch)
      throw HostBusError(
          fmt::format("host bus: IOCHRDY stays low in the {} cycle at {}{:X}; expected: high within 15.6 us (t10)",
                      write ? "write" : "read", memory ? "memory address 0x" : "I/O address 0x", address));
  }
  advance_to(fs_to_tick_floor(end - isa::kReadSetup));
  const auto read = static_cast<std::uint16_t>(machine_.outputs().get(pin::kIsaSd));
  drive_at(end, [&](HostInputs& in) { strobe(in, true); });
  drive_at(end + (times.release - times.command_high), [](HostInputs& in) {
    in.isa_sd = kIdleData;
    in.isa_sbhe_n = true;
  });
  free_at_ = end + (times.next - times.command_high);
  return memory ? read : read & 0xFF;
}

std::uint8_t HostBus::io_read(std::uint32_t offset) {
  return static_cast<std::uint8_t>(cycle(Command::kIoRead, kIoBase + offset, 0));
}

void HostBus::io_write(std::uint32_t offset, std::uint8_t value) { cycle(Command::kIoWrite, kIoBase + offset, value); }

std::uint16_t HostBus::dpram_read(std::uint32_t byte_offset) {
  return cycle(Command::kMemoryRead, kDpramWindow + byte_offset, 0);
}

void HostBus::dpram_write(std::uint32_t byte_offset, std::uint16_t value) {
  cycle(Command::kMemoryWrite, kDpramWindow + byte_offset, value);
}

// ----------------------------------------------------------------------------------------------------------- host port

void HostBus::open_port() {
  io_write(regs::host_io::kData5, 0);
  io_write(regs::host_io::kData6, 0);
}

bool HostBus::put_char(std::uint8_t c, Tick timeout) {
  const Tick limit = now() + timeout;
  while (!(port_status() & kTxde)) {
    if (now() >= limit || tripped()) return false;
    pause_polling();
  }
  io_write(regs::host_io::kData7, c);
  return true;
}

std::optional<std::uint8_t> HostBus::get_char(Tick timeout) {
  const Tick limit = now() + timeout;
  while (!(port_status() & kRxdf)) {
    if (now() >= limit || tripped()) return std::nullopt;
    pause_polling();
  }
  return io_read(regs::host_io::kData7);
}

// ------------------------------------------------------------------------------------------------ interrupt controller

HostBus::Pic HostBus::read_pic() {
  Pic pic{};
  pic.ist = read_pic_status();
  pic.sig = read_pic_signals();
  pic.msk = io_read(regs::host_io::kPicMask);
  pic.elr = io_read(regs::host_io::kPicEdgeLevel);
  return pic;
}

void HostBus::write_pic_mask(std::uint8_t v) { io_write(regs::host_io::kPicMask, v); }
void HostBus::write_pic_edge_level(std::uint8_t v) { io_write(regs::host_io::kPicEdgeLevel, v); }
void HostBus::clear_pic() { io_write(regs::host_io::kPicStatus, 0); }

HostBus::Pic8259 HostBus::read_8259() {
  constexpr std::uint8_t kSelectIrr = 0x0A, kSelectIsr = 0x0B;  // OCW3
  Pic8259 pic{};
  command_8259(kSelectIrr);
  pic.irr = io_read(kCommand8259);
  command_8259(kSelectIsr);
  pic.isr = io_read(kCommand8259);
  pic.imr = io_read(kMask8259);
  return pic;
}

}  // namespace brick
