// Random traffic on the board's pins, see board_traffic.h.
#include "testbench/unit/cosim/board_traffic.h"

#include <algorithm>

#include "rtl/regs/brick_regs.hpp"

namespace brick {

namespace {
constexpr Tick kShortestLegal = 9;  // ticks of a strobe, host-bus:2.5: 78.7 ns
constexpr unsigned kTrippedAccesses = 60;
constexpr Tick kTripTime = 3'000'000;  // without a strobe the watchdog trips after 25 ms = 2949120 ticks
}  // namespace

void start_clocks(Board& board, BoardInputs& inputs) {
  board.run_until(30);
  inputs.rst_n = true;
  inputs.pa_addr = regs::kGateIcs[0].base + regs::servo_ic::kClockControl.address;
  inputs.pa_x = true;
  inputs.pa_aa = 2;
  inputs.pa_wdata = regs::servo_ic::kClockControl.reset & ~regs::servo_ic::clock_control::kPhaseExternal.mask() &
                    ~regs::servo_ic::clock_control::kServoExternal.mask();
  board.set_inputs(inputs);
  board.run_until(40);  // the reset has ended after tick 38
  inputs.pa_wr_n = false;
  board.set_inputs(inputs);
  board.run_until(52);
  inputs.pa_wr_n = true;
  board.set_inputs(inputs);
  board.run_until(kClocksStarted);
}

BoardTraffic::BoardTraffic(std::uint64_t seed, Options options) : random_(seed), ssi_random_(~seed), options_(options) {
  inputs_.ssi_kind = static_cast<std::uint8_t>(ssi_random_() % 4);
  for (unsigned line = 0; line < 3; ++line)
    inputs_.line_select = static_cast<std::uint16_t>(inputs_.line_select << 4 | (pick(8) == 0 ? 0 : 1 + pick(15)));
  const unsigned ir5 = inputs_.line_select & 0xF;  // moves in every life: an EQU
  inputs_.line_select = static_cast<std::uint16_t>((inputs_.line_select & ~0xF) | (1 + (ir5 + 7) % 8));
  inputs_.jpan_fitted = pick(2) != 0;
  inputs_.dpram_small = pick(2) != 0;
  for (unsigned ic = 0; ic < regs::kGateIcs.size(); ++ic)
    if ((options.ics >> ic & 1) != 0) ics_.push_back(ic);
  inputs_.fitted = options.ics;
  reset_at_ = 12 + pick(30);  // released there
  cpu_.at = host_.at = outside_at_ = reset_at_ + 10;
}

std::uint32_t BoardTraffic::pick(std::uint32_t below) { return static_cast<std::uint32_t>(random_() % below); }

unsigned BoardTraffic::one_of_ics() { return ics_[pick(static_cast<std::uint32_t>(ics_.size()))]; }

Tick BoardTraffic::next() const { return std::min({cpu_.at, host_.at, outside_at_, reset_at_}); }

void BoardTraffic::run(Board& board, Tick end) {
  board.set_inputs(inputs_);
  Tick others_moved = board.now();
  while (next() < end) {
    board.run_until(next());
    if (std::min({host_.at, outside_at_, reset_at_}) == board.now()) others_moved = board.now();
    change();
    board.set_inputs(inputs_);
    // What follows Port A without a clock. Of two boards as one it is compared.
    if (others_moved != board.now()) static_cast<void>(board.port_a_at_once());
  }
  board.run_until(end);
}

void BoardTraffic::change() {
  const Tick now = next();
  if (reset_at_ == now) {
    in_reset_ = !in_reset_;
    seen_.reset_in_cycle += in_reset_ && (!inputs_.pa_rd_n || !inputs_.pa_wr_n);
    inputs_.rst_n = !in_reset_;
    if (in_reset_) inputs_.pwr_good = true;
    reset_at_ = in_reset_ ? now + 1 + pick(40) : kNever;
    driver_ = one_of_ics();
  }
  if (cpu_.at == now) cpu_step();
  if (host_.at == now) host_step();
  if (outside_at_ == now) outside_step();
}

// External PHASE and SERVO, interrupt lines, jumper E1, now and then what is fitted and of which kind.
void BoardTraffic::outside_step() {
  static constexpr bool BoardInputs::*interrupt_lines[] = {&BoardInputs::mi1, &BoardInputs::mi2, &BoardInputs::axexp0,
                                                           &BoardInputs::axexp1};
  switch (pick(8)) {
    case 0:
      if (pick(8) == 0) inputs_.ext_clock = !inputs_.ext_clock;
      break;
    case 1:
      if (pick(4) == 0) inputs_.fitted = pick(3) == 0 ? pick(1u << regs::kGateIcs.size()) : options_.ics;
      break;
    case 2:
      if (pick(2) == 0) inputs_.macro_gate = pick(16);
      break;
    case 5: {
      bool& line = inputs_.*interrupt_lines[pick(4)];
      line = !line;
      if (pick(8) == 0) inputs_.pic_8259 = !inputs_.pic_8259;
      if (pick(8) == 0) inputs_.jpan_fitted = !inputs_.jpan_fitted;
      break;
    }
    case 3:
    case 4:
      inputs_.ext_servo = !inputs_.ext_servo;
      break;
    default:
      inputs_.ext_phase = !inputs_.ext_phase;
      break;
  }
  inputs_.ssi_data = static_cast<std::uint8_t>(ssi_random_());
  outside_at_ += 1 + pick(500);
}

void BoardTraffic::pause() {
  if (options_.dense || pick(60) != 0) return;
  const Tick ticks = 1000 + pick(60'000);
  for (Tick* at : {&cpu_.at, &host_.at, &outside_at_})
    if (*at != rests_until_) *at += ticks;
}

// Words of the serial encoder inputs, mostly those that make frames follow each other: every channel, short periods.
void BoardTraffic::choose_ssi() {
  const auto below = [this](std::uint32_t n) { return static_cast<std::uint32_t>(ssi_random_() % n); };
  const bool geo = inputs_.ssi_kind % 2 != 0;
  inputs_.pa_aa = 2;
  inputs_.pa_addr = geo ? regs::kSsiPageBase + below(4) * 0x20 + 0x14 + below(3) : regs::ssi_brick::kBase + below(32);
  if (below(3) != 0) return;
  inputs_.pa_x = true;
  const bool timing = below(4) == 0;
  if (geo) {
    inputs_.pa_addr = regs::ssi_geo::kControl.address + (timing ? 1 : 0x20 * below(2));
    inputs_.pa_wdata = 3;
  } else {
    inputs_.pa_addr =
        timing ? regs::ssi_brick::kTiming.address + 0x10 * below(2) : regs::ssi_brick::kBase + 4 * below(8);
    inputs_.pa_wdata = timing ? below(4) << 8 | 2 : 0x1400 | below(1u << 16);
  }
}

void BoardTraffic::choose_cpu_address() {
  // Registers of an IC's clocks, its other words, EQU by hand, all gate ICs, DPRAM (few words, the first most of all,
  // so that the sides meet), latches, the host port, and addresses in no region with any area select.
  inputs_.pa_int = false;
  inputs_.pa_x = pick(2) != 0;
  switch (pick(9)) {
    case 0:
      choose_clock_address();
      break;
    case 8: {
      using namespace regs::servo_channel;
      inputs_.pa_addr = regs::kGateIcs[pick(2)].base + 8 * pick(4) + kControl.address;
      inputs_.pa_x = true;
      inputs_.pa_aa = 2;
      inputs_.pa_wdata = control::kEquState.set(control::kEquWrite.set(inputs_.pa_wdata, 1), pick(2));
      break;
    }
    case 1:
      inputs_.pa_addr = regs::kGateIcs[one_of_ics()].base + pick(64);
      inputs_.pa_aa = 2;
      break;
    case 2:
      inputs_.pa_addr = 0x078000 + (pick(4) == 0 ? 0x0800 : pick(0x4000));
      inputs_.pa_aa = 2;
      break;
    case 3:
    case 4:
      inputs_.pa_addr = 0x060000 + (pick(4) == 0 ? (pick(2) == 0 ? 0x3FFC : 0x0FFE) : 0) + (pick(2) == 0 ? 0 : pick(4));
      inputs_.pa_aa = 4;
      break;
    case 5:
      inputs_.pa_addr = 0x070000 + (pick(3) == 0 ? pick(256) : 0x10 + pick(3));
      inputs_.pa_aa = 0;
      break;
    case 6:
      inputs_.pa_addr = pick(4) == 0 ? pick(128) : 0x42 + pick(6);
      inputs_.pa_x = true;
      inputs_.pa_int = true;
      inputs_.pa_aa = 0;
      break;
    default:
      inputs_.pa_addr = pick(1u << 19);
      inputs_.pa_aa = static_cast<std::uint8_t>(pick(16));
      break;
  }
  if (!inputs_.pa_int && ssi_random_() % 12 == 0) choose_ssi();
}

// Of both kinds of IC, whose fields are the same. The data goes with it.
void BoardTraffic::choose_clock_address() {
  const unsigned ic = one_of_ics();
  const auto& [name, macro, base, variable] = regs::kGateIcs[ic];
  const bool count = pick(3) == 0;
  inputs_.pa_addr = base + (macro ? (count ? regs::macro_ic::kPwmControl : regs::macro_ic::kClockControl)
                                  : (count ? regs::servo_ic::kPwmControl : regs::servo_ic::kClockControl))
                               .address;
  inputs_.pa_x = true;
  inputs_.pa_aa = 2;
  if (pick(8) == 0) return;
  if (count)
    inputs_.pa_wdata = regs::servo_ic::pwm_control::kMaxCount.set(pick(256), pick(4) == 0 ? pick(7000) : pick(100));
  else
    inputs_.pa_wdata = choose_clock_data(ic == driver_);
}

// Short clocks, so that PHASE and SERVO move often; one IC drives them and the others follow, but for every second
// word.
std::uint32_t BoardTraffic::choose_clock_data(bool drives) {
  using namespace regs::servo_ic;
  const std::uint32_t external = pick(2) == 0 ? pick(4) : (drives ? 0 : 3);
  std::uint32_t word = choose_cpu_data() & 0xFFF;
  word = clock_control::kPhaseExternal.set(word, external & 1);
  word = clock_control::kServoExternal.set(word, external >> 1);
  word = clock_control::kPhaseDivider.set(word, pick(3) == 0 ? pick(16) : 0);
  return clock_control::kServoDivider.set(word, pick(3) == 0 ? pick(16) : pick(3));
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

// A strobe from far too short to long; the next one after a rest, at once, or within the same tick: at the fastest CPU
// clock the least high is shorter than one. Now and then what no bus master does: both strobes, or another address in
// the middle of a cycle.
void BoardTraffic::cpu_step() {
  const Tick step = 1 + pick(4);
  bool& strobe = cpu_.write ? inputs_.pa_wr_n : inputs_.pa_rd_n;
  switch (cpu_.step++) {
    case 0:
      inputs_.pa_wdata = choose_cpu_data();
      choose_cpu_address();
      if (pick(4) == 0) inputs_.jpan = static_cast<std::uint16_t>(pick(0x10000));
      cpu_.write = pick(2) != 0;
      if (tripped_accesses_ % 5 == 1) {
        inputs_.pa_addr = regs::board_latches::kControlOutputs.address;
        inputs_.pa_x = cpu_.write = true;
        inputs_.pa_int = false;
        inputs_.pa_aa = 0;
        ++seen_.writes_tripped;
      }
      cpu_.dpram_accesses += inputs_.pa_aa == 4 && inputs_.pa_addr - regs::kDpramBase < regs::kDpramSize;
      ++cpu_.accesses;
      cpu_.at += hurries_ ? pick(2) : step;
      break;
    case 1:
      strobe = false;
      cpu_.fell = cpu_.at;
      cpu_.at += pick(4);
      break;
    case 2:
      if (cpu_.write && pick(2) != 0) inputs_.pa_wdata = choose_cpu_data();  // behind the strobe
      if (pick(40) == 0) {
        inputs_.pa_rd_n = inputs_.pa_wr_n = false;
        ++seen_.both_strobes;
      }
      if (pick(40) == 0) {
        choose_cpu_address();
        ++seen_.address_moved;
      }
      cpu_.at += pick(2) == 0 ? 9 + pick(2) : pick(22);  // legal, or anything
      break;
    case 3:
      inputs_.pa_rd_n = inputs_.pa_wr_n = true;
      seen_.too_short += cpu_.at - cpu_.fell < kShortestLegal;
      if (inputs_.pa_int && pick(2) == 0) {  // the CPU may show something else at once
        inputs_.pa_int = pick(2) != 0;
        inputs_.pa_addr = pick(10);
      }
      hurries_ = pick(3) == 0;
      seen_.back_to_back += hurries_;
      cpu_.at += hurries_ ? pick(2) : step;
      break;
    default:
      if (pick(2) != 0 && !hurries_) inputs_.pa_aa = 0, inputs_.pa_int = false;
      cpu_.step = 0;
      if (!hurries_) cpu_.at += 1 + pick(12);
      pause();
      if (options_.fail_every != 0) fail_or_recover();
      if (options_.reset_one_in != 0 && pick(options_.reset_one_in) == 0 && reset_at_ == kNever)
        reset_at_ = cpu_.at + pick(20);
      if (cpu_.at >= options_.silent_at && reset_at_ == kNever) {
        options_.silent_at = kNever;
        rests_until_ = cpu_.at += kTripTime;
        reset_at_ = cpu_.at + pick(200'000);
      }
      break;
  }
}

// The watchdog trips while everything goes on.
void BoardTraffic::fail_or_recover() {
  if (tripped_accesses_ > 0 && --tripped_accesses_ == 0 && reset_at_ == kNever) reset_at_ = cpu_.at + 1 + pick(20);
  if (in_reset_) tripped_accesses_ = 0;
  if (cpu_.accesses % options_.fail_every != 0 || reset_at_ != kNever) return;
  inputs_.pwr_good = false;
  tripped_accesses_ = kTrippedAccesses;
}

void BoardTraffic::choose_host_address() {
  host_.memory = pick(3) == 0;
  if (host_.memory) {
    const std::uint32_t offset =
        pick(4) == 0 ? pick(0x10000)
                     : (pick(4) == 0 ? (pick(2) == 0 ? 0xFFF0 : 0x3FF8) : 0) + (pick(2) == 0 ? pick(4) : pick(16));
    const std::uint32_t window = static_cast<std::uint32_t>(inputs_.window) << 14;
    inputs_.set_address((window ^ (pick(8) == 0 ? 1u << (14 + pick(10)) : 0)) + offset);
  } else {
    inputs_.set_address((16u * inputs_.io_base + pick(16)) ^ (pick(8) == 0 ? 1u << (4 + pick(12)) : 0));
  }
  ++host_.accesses;
  if (pick(100) == 0) choose_host_set_up();
  if (pick(20) == 0) static_cast<IsaStraps&>(inputs_) = {};
  inputs_.isa_resetdrv = pick(200) == 0;  // to the next cycle
  host_.dpram_accesses += host_.memory && inputs_.isa_sa - regs::kDpramWindowBase < regs::kDpramWindowSize;
  inputs_.isa_sbhe_n = pick(2) != 0;
  inputs_.isa_aen = pick(16) == 0;
  inputs_.isa_sd = static_cast<std::uint16_t>(pick(4) == 0 ? pick(0x10000) : 1u << pick(16));
}

void BoardTraffic::choose_host_set_up() {
  inputs_.io_base = static_cast<std::uint8_t>(pick(0x100));
  inputs_.io_decode16 = pick(2) != 0;
  inputs_.window = static_cast<std::uint16_t>(pick(0x400));
  inputs_.window_flat = pick(2) != 0;
  inputs_.slot8 = pick(2) != 0;
}

// Some hosts are unsound: commands of an edge or two, highs as short, a second command at the same time, commands that
// follow one another at once, an address that moves.
void BoardTraffic::host_step() {
  bool* const strobes[] = {&inputs_.isa_ior_n, &inputs_.isa_iow_n, &inputs_.isa_memr_n, &inputs_.isa_memw_n};
  bool& strobe = *strobes[(host_.memory ? 2 : 0) + (host_.write ? 1 : 0)];
  switch (host_.step++) {
    case 0:
      choose_host_address();
      host_.write = pick(2) != 0;
      host_.at += 3 + pick(12);
      break;
    case 1:
      strobe = false;
      if (pick(24) == 0) *strobes[pick(4)] = false;
      host_.at += pick(8) == 0 ? 1 + pick(10) : 20 + pick(60);
      break;
    case 2:
      for (bool* const s : strobes) *s = true;
      if (pick(6) == 0) {  // and again
        host_.step = 1;
        if (pick(4) == 0) *strobes[pick(4)] = false;
        if (pick(4) == 0) inputs_.isa_sa ^= 1u << pick(17);
        host_.at += 1 + pick(4);
        break;
      }
      host_.at += 1 + pick(12);
      break;
    default:
      host_.step = 0;
      host_.at += 1 + pick(30);
      pause();
      break;
  }
}

}  // namespace brick
