// Random traffic on the board's pins, see board_traffic.h.
#include "testbench/unit/cosim/board_traffic.h"

#include <algorithm>

#include "rtl/regs/brick_regs.hpp"

namespace brick {

namespace {
constexpr std::uint32_t kClockWords[] = {0x078004, 0x078104};  // directions and dividers
constexpr std::uint32_t kMaxPhase[] = {0x07801C, 0x07811C};    // PWM count
bool is_one_of(std::uint32_t address, const std::uint32_t (&list)[2]) {
  return address == list[0] || address == list[1];
}
}  // namespace

void start_clocks(Board& board, BoardInputs& inputs) {
  board.run_until(30);
  inputs.rst_n = true;
  inputs.pa_addr = kClockWords[0];
  inputs.pa_x = true;
  inputs.pa_aa = 2;
  inputs.pa_wdata = regs::servo_ic::kClockControl.reset & ~regs::servo_ic::clock_control::kPhaseExternal.mask() &
                    ~regs::servo_ic::clock_control::kServoExternal.mask();
  board.set_inputs(inputs);
  board.run_until(36);
  inputs.pa_wr_n = false;
  board.set_inputs(inputs);
  board.run_until(48);
  inputs.pa_wr_n = true;
  board.set_inputs(inputs);
  board.run_until(kClocksStarted);
}

BoardTraffic::BoardTraffic(std::uint64_t seed, Options options) : random_(seed), options_(options) {
  for (unsigned line = 0; line < 3; ++line)
    inputs_.line_select = static_cast<std::uint16_t>(inputs_.line_select << 4 | pick(16));
  inputs_.jpan_fitted = pick(2) != 0;
  inputs_.dpram_small = pick(2) != 0;
  reset_at_ = 12 + pick(30);  // released there
  cpu_.at = host_.at = reset_at_ + 10;
}

std::uint32_t BoardTraffic::pick(std::uint32_t below) { return static_cast<std::uint32_t>(random_() % below); }

Tick BoardTraffic::next() const { return std::min({cpu_.at, host_.at, reset_at_}); }

void BoardTraffic::change() {
  const Tick now = next();
  if (reset_at_ == now) {
    in_reset_ = !in_reset_;
    inputs_.rst_n = !in_reset_;
    reset_at_ = in_reset_ ? now + 1 + pick(40) : kNever;
  }
  if (cpu_.at == now) cpu_step();
  if (host_.at == now) host_step();
}

void BoardTraffic::choose_cpu_address() {
  // Registers of a servo IC's clocks, its other words, all gate ICs, DPRAM (few words, so that the sides meet),
  // latches, the host port, and addresses in no region with any area select.
  inputs_.pa_int = false;
  inputs_.pa_x = pick(2) != 0;
  switch (pick(8)) {
    case 0:
      inputs_.pa_addr = pick(3) == 0 ? kMaxPhase[pick(2)] : kClockWords[pick(2)];
      inputs_.pa_x = true;
      inputs_.pa_aa = 2;
      break;
    case 1:
      inputs_.pa_addr = 0x078000 + (pick(2) << 8) + pick(64);
      inputs_.pa_aa = 2;
      break;
    case 2:
      inputs_.pa_addr = 0x078000 + (pick(4) == 0 ? 0x0800 : pick(0x4000));
      inputs_.pa_aa = 2;
      break;
    case 3:
    case 4:
      inputs_.pa_addr = 0x060000 + (pick(4) == 0 ? (pick(2) == 0 ? 0x3FFC : 0x0FFE) : 0) + pick(4);
      inputs_.pa_aa = 4;
      break;
    case 5:
      inputs_.pa_addr = 0x070000 + (pick(3) == 0 ? pick(256) : 0x10 + pick(2));
      inputs_.pa_aa = 0;
      break;
    case 6:
      inputs_.pa_addr = pick(4) == 0 ? pick(64) : 2 + pick(6);
      inputs_.pa_x = true;
      inputs_.pa_int = true;
      inputs_.pa_aa = 0;
      break;
    default:
      inputs_.pa_addr = pick(1u << 19);
      inputs_.pa_aa = static_cast<std::uint8_t>(pick(16));
      break;
  }
}

std::uint32_t BoardTraffic::choose_cpu_data() {
  switch (pick(4)) {
    case 0:
      return pick(1u << 24);
    case 1:
      return pick(16);
    case 2:
      return pick(256);
    default:
      return 1u << pick(24);
  }
}

// Short clocks, so that PHASE and SERVO move often; mostly one IC as source, sometimes none or both.
std::uint32_t BoardTraffic::choose_clock_data() {
  using namespace regs::servo_ic;
  if (is_one_of(inputs_.pa_addr, kMaxPhase))
    return pwm_control::kMaxCount.set(pick(256), pick(4) == 0 ? pick(7000) : pick(100));
  std::uint32_t word = choose_cpu_data() & 0xFFF;
  const std::uint32_t external = pick(3) == 0 ? pick(4) : (inputs_.pa_addr == kClockWords[0] ? 0 : 3);
  word = clock_control::kPhaseExternal.set(word, external & 1);
  word = clock_control::kServoExternal.set(word, external >> 1);
  word = clock_control::kPhaseDivider.set(word, pick(3) == 0 ? pick(16) : 0);
  return clock_control::kServoDivider.set(word, pick(3) == 0 ? pick(16) : pick(3));
}

void BoardTraffic::cpu_step() {
  const Tick step = 1 + pick(4);
  bool& strobe = cpu_.write ? inputs_.pa_wr_n : inputs_.pa_rd_n;
  switch (cpu_.step++) {
    case 0:
      choose_cpu_address();
      if (pick(4) == 0) inputs_.jpan = static_cast<std::uint16_t>(pick(0x10000));
      cpu_.write = pick(2) != 0;
      if (cpu_.write) {
        const bool clocks =
            inputs_.pa_x && (is_one_of(inputs_.pa_addr, kClockWords) || is_one_of(inputs_.pa_addr, kMaxPhase));
        inputs_.pa_wdata = clocks && pick(8) != 0 ? choose_clock_data() : choose_cpu_data();
      }
      cpu_.at += step;
      break;
    case 1:
      strobe = false;
      cpu_.at += 1 + pick(24);  // from far too short to long
      break;
    case 2:
      strobe = true;
      cpu_.at += pick(3) == 0 ? 1 : step;
      break;
    default:
      if (pick(2) != 0) inputs_.pa_aa = 0, inputs_.pa_int = false;
      cpu_.step = 0;
      cpu_.at += options_.dense ? 1 + pick(12) : 500 + pick(20'000);
      if (options_.reset_one_in != 0 && pick(options_.reset_one_in) == 0 && reset_at_ == kNever)
        reset_at_ = cpu_.at + pick(20);
      break;
  }
}

void BoardTraffic::choose_host_address() {
  host_.memory = pick(3) == 0;
  if (host_.memory) {
    const std::uint32_t offset =
        pick(4) == 0 ? pick(0x10000) : (pick(4) == 0 ? (pick(2) == 0 ? 0xFFF0 : 0x3FF8) : 0) + pick(16);
    inputs_.isa_sa = (pick(16) == 0 ? 0xC0000 : 0xD0000) + offset;
  } else {
    inputs_.isa_sa = (pick(16) == 0 ? pick(0x400) : regs::host_io::kBase + pick(16));
  }
  inputs_.isa_sbhe_n = pick(2) != 0;
  inputs_.isa_aen = pick(16) == 0;
  inputs_.isa_sd = static_cast<std::uint16_t>(pick(4) == 0 ? pick(0x10000) : 1u << pick(16));
}

void BoardTraffic::host_step() {
  bool& strobe = host_.memory ? (host_.write ? inputs_.isa_memw_n : inputs_.isa_memr_n)
                              : (host_.write ? inputs_.isa_iow_n : inputs_.isa_ior_n);
  switch (host_.step++) {
    case 0:
      choose_host_address();
      host_.write = pick(2) != 0;
      host_.at += 3 + pick(12);
      break;
    case 1:
      strobe = false;
      host_.at += pick(8) == 0 ? 1 + pick(10) : 20 + pick(60);
      break;
    case 2:
      strobe = true;
      host_.at += 1 + pick(12);
      break;
    default:
      host_.step = 0;
      host_.at += options_.dense ? 1 + pick(30) : 500 + pick(20'000);
      break;
  }
}

}  // namespace brick
