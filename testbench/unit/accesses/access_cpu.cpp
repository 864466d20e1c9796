#include "testbench/unit/accesses/access_cpu.h"

#include <numeric>
#include <utility>

#include "rtl/regs/brick_regs.hpp"
#include "testbench/checkers/timing_port_a.h"

namespace brick {

namespace {

constexpr unsigned kMostWaitStates = 0x1FFFFF, kFirstMacroIc = 18;
constexpr std::uint32_t kGateBase = 0x078000, kGateSize = 0x4000, kPanelWord = 0x078800;
constexpr std::uint32_t kLatchBase = 0x070000, kOnChipBase = 0xFFFF80;

// host-bus:2.5, rows 2, 3 and 5, for I52.
struct LeastWaitStates {
  unsigned i52, gate, dpram, latches;
};
constexpr LeastWaitStates kLeast[] = {{4, 8, 4, 15},   {7, 8, 3, 15},   {9, 10, 4, 15},
                                      {15, 16, 7, 31}, {23, 24, 7, 31}, {31, 31, 7, 31}};

}  // namespace

AccessCpu::AccessCpu(Machine& machine, std::uint64_t seed, bool too_fast)
    : machine_(machine), too_fast_(too_fast), random_(seed) {
  machine_.attach_bus_master(this);
}

std::uint64_t AccessCpu::made() const {
  return std::accumulate(made_.begin(), made_.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const auto& m) { return sum + m[0] + m[1]; });
}

std::optional<BusMaster::Access> AccessCpu::next() {
  if (!queue_.empty()) return queue_.front();
  choose();
  chosen_.idle += std::exchange(rest_, 0);
  return chosen_;
}

void AccessCpu::done(const Access& access, std::uint32_t) {
  if (access.address == regs::cpu_bus::kBcr.address || access.address == regs::cpu_bus::kPctl.address)
    queue_.pop_front();
  else
    ++made_[region_][access.write];
}

// Another clock with slow cycles, then the wait states for it. A few cycles later the clock stands at another phase.
void AccessCpu::another_clock() {
  using namespace regs::cpu_bus::bcr;
  const unsigned i52 = too_fast_ ? 7 : pick(machine_.skew().on() ? 16 : 32);  // host-bus:2.5 promises no more
  const LeastWaitStates* least = kLeast;
  while (least->i52 < i52) ++least;
  const auto from = [this](unsigned ws, unsigned most) {
    return pick(4) != 0 ? ws : std::min(most, ws + pick(most - ws + 1));
  };
  std::uint32_t bcr = kBa1w.at(too_fast_ ? 2 : from(least->gate, 31));
  bcr |= kBa2w.at(from(least->dpram, 7)) | kBdfw.at(from(least->latches, 31));
  const std::uint32_t to_bcr = regs::cpu_bus::kBcr.address, to_pctl = regs::cpu_bus::kPctl.address;
  queue_ = {{true, to_bcr, true, kMostWaitStates, 0}, {true, to_pctl, true, i52, 0}, {true, to_bcr, true, bcr, 0}};
}

std::uint32_t AccessCpu::data() {
  switch (pick(3)) {
    case 0:
      return pick(1u << 24);
    case 1:
      return pick(256);
    default:
      return 1u << pick(24);
  }
}

// Base of a fitted one; of servo IC 0 if there is none of the kind.
std::uint32_t AccessCpu::gate_ic(bool macro) {
  const std::uint32_t kind = macro ? ~0u << kFirstMacroIc : (1u << kFirstMacroIc) - 1;
  const std::uint32_t fitted = machine_.fitted() & kind;
  if (fitted == 0) return regs::kGateIcs[0].base;
  unsigned ic = 0;
  do ic = pick(static_cast<std::uint32_t>(regs::kGateIcs.size()));
  while ((fitted >> ic & 1) == 0);
  return regs::kGateIcs[ic].base;
}

void AccessCpu::choose() {
  chosen_ = {pick(2) != 0, 0, pick(2) != 0, data(), pick(3) == 0 ? pick(40) : 0};
  switch (pick(16)) {
    case 0:
      region_ = kServoIcs;
      clock_word();
      break;
    case 1:
    case 2:
    case 3:
      region_ = kServoIcs;
      pick(4) == 0 ? compare_output() : void(chosen_.address = gate_ic(false) + pick(32));
      break;
    case 4:
    case 5:
      region_ = (machine_.fitted() >> kFirstMacroIc) != 0 ? kMacroIcs : kServoIcs;
      chosen_.address = gate_ic(true) + pick(64);
      break;
    case 6:
      region_ = kNoIc;  // or a fitted one by chance
      pick(2) == 0 ? serial_inputs() : void(chosen_.address = kGateBase + pick(kGateSize));
      break;
    case 7:
      region_ = kPanel;
      chosen_.address = kPanelWord;
      break;
    case 8:
    case 9:
    case 10:
    case 11:
      region_ = kDpram;
      chosen_.address = regs::kDpramBase + (pick(4) == 0 ? pick(regs::kDpramSize) : pick(2));
      break;
    case 12:
    case 13:
      region_ = kLatches;
      chosen_.address = kLatchBase + (pick(4) == 0 ? pick(256) : 0x10 + pick(3));
      chosen_.x = pick(8) != 0;
      break;
    default:
      region_ = kOnChip;
      chosen_.x = true;
      do chosen_.address = pick(4) == 0 ? kOnChipBase + pick(128) : regs::hi08::kBase + pick(6);
      while (chosen_.address == regs::cpu_bus::kBcr.address || chosen_.address == regs::cpu_bus::kPctl.address);
      break;
  }
}

// Every channel of the serial encoder inputs enabled sooner or later, at short periods; and all of their words read.
void AccessCpu::serial_inputs() {
  using namespace regs::ssi_brick;
  chosen_.address = kBase + pick(32);
  if (!chosen_.write) return;
  chosen_.x = true;
  const bool times = pick(4) == 0;
  chosen_.address = times ? kTiming.address + 0x10 * pick(2) : kControl.address + 4 * pick(8);
  chosen_.data = times ? timing::kFalling.at(pick(2)) | timing::kOnServo.at(pick(2)) | timing::kProtocol.at(2)
                       : control::kTrigger.at(1) | control::kDriver.at(1) | pick(64);
}

// EQU of a channel of servo IC 0 or 1 by hand: lines of the interrupt controller.
void AccessCpu::compare_output() {
  using namespace regs::servo_channel;
  chosen_.x = chosen_.write = true;
  chosen_.address = regs::kGateIcs[pick(2)].base + 8 * pick(4) + kControl.address;
  chosen_.data = control::kEquState.set(control::kEquWrite.set(chosen_.data, 1), pick(2));
}

// Short periods; mostly servo IC 0 drives both clocks, and now and then another one too.
void AccessCpu::clock_word() {
  using namespace regs::servo_ic;
  chosen_.x = chosen_.write = true;
  const std::uint32_t base = pick(2) == 0 ? regs::kGateIcs[0].base : gate_ic(false);
  if (pick(3) == 0) {
    chosen_.address = base + kPwmControl.address;
    chosen_.data = pwm_control::kMaxCount.set(pick(256), pick(100));
    return;
  }
  const bool drives = base == regs::kGateIcs[0].base ? pick(8) != 0 : pick(8) == 0;
  chosen_.address = base + kClockControl.address;
  chosen_.data = clock_control::kServoDivider.at(pick(3)) | clock_control::kPhaseDivider.at(pick(3)) | (data() & 0xFFF);
  if (!drives) chosen_.data |= clock_control::kPhaseExternal.mask() | clock_control::kServoExternal.mask();
}

}  // namespace brick
