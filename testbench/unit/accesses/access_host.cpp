#include "testbench/unit/accesses/access_host.h"

#include <algorithm>

namespace brick {

namespace {
constexpr unsigned kData7 = 7;
constexpr Tick kInReset = 160;  // the reset line is low for 120 ticks
constexpr Tick kApart = 40;     // more than the longest time between two strobes, host-bus:3.3/3
}  // namespace

AccessHost::AccessHost(Machine& machine, AccessCpu& cpu, std::uint64_t seed, bool memory)
    : bus_(machine), cpu_(cpu), memory_(memory), random_(seed) {
  bus_.set_pace([this] { return pick(3) == 0 ? pick(4'000'000'000) : pick(8'500'000); });  // femtoseconds
  times();
  bus_.wait(kInReset);
  // A reset comes by chance once in some hundred steps: behind a cycle of either kind each life has one anyhow.
  io();
  reset_drive();
  if (memory_) memory_word();
  reset_drive();
}

void AccessHost::times() {
  isa::HostTimes times = std::array{isa::kTypical, isa::kTight, isa::kTight, isa::kSlow}[pick(4)];
  times.grid = 1;
  // At the limit for the host port too, whose CPU may be at its slowest clock (host-bus:3.3/3, host-bus:3.3/5: 257.6
  // ns).
  times.io.next = std::max(times.io.next, times.io.command_high + isa::ns(258) - times.io.command_low);
  bus_.set_times(times);
  bus_.wait(kApart);  // the least times between two cycles are those of the first
}

void AccessHost::step() {
  if (pick(20) == 0) times();
  switch (pick(100)) {
    case 0:
    case 1:
    case 2:
      connectors();
      break;
    case 3:
      bus_.drive_at(soon(), [](HostInputs& in) { in.isa_aen = true; });  // the next I/O cycle lets it go
      break;
    case 4:
      if (pick(4) == 0) reset_drive();
      if (pick(8) == 0) reset();
      break;
    case 5:
    case 6:
    case 7:
    case 8:
    case 9:
      another_clock();
      break;
    default:
      memory_&& pick(2) == 0 ? memory_word() : io();
      break;
  }
}

void AccessHost::io() {
  const std::uint32_t port = (bus_.io_base() + pick(16)) ^ (pick(16) == 0 ? 1u << (4 + pick(12)) : 0);
  if (port % 8 == kData7) bus_.wait(kApart);  // what the cycle before has written shows in TXDE
  const bool full = bus_.machine().outputs().get(pin::kTxde) == 0;
  if (pick(2) == 0 || (full && port % 8 == kData7)) {
    bus_.read_io(port);
    ++made_[kIoRead];
  } else {
    bus_.write_io(port, static_cast<std::uint8_t>(pick(2) == 0 ? pick(256) : 1u << pick(8)));
    ++made_[kIoWrite];
  }
}

// Mostly the words that the CPU is in; on the other boards of the bus in an eighth of all cases.
void AccessHost::memory_word() {
  const std::uint32_t size = bus_.machine().inputs().window_flat ? 0x10000 : 0x4000;
  const std::uint32_t offset = pick(4) == 0 ? pick(size / 2) : pick(4);
  const std::uint32_t address = (bus_.window() + 2 * offset) ^ (pick(8) == 0 ? 1u << (14 + pick(10)) : 0);
  const unsigned lanes = pick(2) == 0 ? 3 : 1 + pick(2);
  if (pick(2) == 0) {
    bus_.read_memory(address, lanes);
    ++made_[kMemoryRead];
  } else {
    bus_.write_memory(address, static_cast<std::uint16_t>(pick(2) == 0 ? pick(0x10000) : 1u << pick(16)), lanes);
    ++made_[kMemoryWrite];
  }
}

// The strobes of the host port are as long as the CPU's clock asks for (host-bus:3.3): it moves between two of them.
void AccessHost::another_clock() {
  cpu_.another_clock();
  while (!cpu_.settled()) bus_.wait(12);
  bus_.wait(kApart);
}

void AccessHost::connectors() {
  static constexpr bool HostInputs::*kLines[] = {&HostInputs::mi1, &HostInputs::mi2, &HostInputs::axexp0,
                                                 &HostInputs::axexp1};
  if (bus_.machine().inputs().jpan_fitted && pick(2) == 0) {
    const auto panel = static_cast<std::uint16_t>(pick(0x10000));
    bus_.drive_at(soon(), [panel](HostInputs& in) { in.jpan = panel; });
    return;
  }
  bool HostInputs::*const line = kLines[pick(4)];
  bus_.drive_at(soon(), [line](HostInputs& in) { in.*line = !(in.*line); });
}

void AccessHost::reset_drive() {
  for (const bool level : {true, false}) bus_.drive_at(soon(), [level](HostInputs& in) { in.isa_resetdrv = level; });
  bus_.drive_at(soon(), [](HostInputs&) {});
}

// By the line, or because 5 V have failed: the watchdog trips and waits for it.
void AccessHost::reset() {
  if (pick(2) == 0) {
    for (const bool good : {false, true}) bus_.drive_at(soon(), [good](HostInputs& in) { in.pwr_good = good; });
    bus_.wait(24);
  }
  cpu_.restart();
  bus_.machine().reset();
  bus_.wait(kInReset);
}

}  // namespace brick
