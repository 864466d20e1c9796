// Random life on the motor side, see motor_traffic.h.
#include "testbench/unit/cosim/motor_traffic.h"

#include <algorithm>
#include <iterator>

#include "rtl/regs/brick_regs.hpp"

namespace brick {

namespace {
// X and Y words of a channel, and the words of a whole IC (docs/registers.md).
constexpr unsigned kOutA = 2, kCapture = 3, kGlobal = 4, kControl = 5, kIncrement = 6, kCompare = 7;
constexpr unsigned kDacStrobe = 0x0C, kAdcStrobe = 0x14, kPwm = 0x1C;
constexpr unsigned kTrippedAccesses = 60;
constexpr Tick kAwake = 10;                     // from the release of the reset to the first access
constexpr Tick kTripTime = 3'000'000;           // without a strobe the watchdog trips after 25 ms = 2949120 ticks
constexpr std::uint32_t kOwnClocks = 0x3008D2;  // as after a reset, PHASE and SERVO driven
constexpr std::uint32_t kInputs = 0x3000;       // in the clock word: PHASE and SERVO are inputs

}  // namespace

MotorTraffic::MotorTraffic(std::uint64_t seed, MotorTrafficOptions options) : random_(seed), options_(options) {
  for (unsigned i = 0; i < kMaxServoIcs; ++i) {
    if ((options.ics >> i & 1) == 0) continue;
    ics_.push_back({});
    ics_.back().index = i;
    ics_.back().address = regs::kGateIcs[i].base;
    ics_.back().at = 40 + below(300);
    for (Channel& c : ics_.back().channels) c.speed = 20 + up_to(4 * options_.pins_pause);
  }
  for (unsigned i = kMaxServoIcs; i < regs::kGateIcs.size(); ++i)
    if ((options.ics >> i & 1) != 0) macro_ics_.push_back(regs::kGateIcs[i].base);
  inputs_.fitted = options.ics;
  if (!macro_ics_.empty()) inputs_.macro_gate = below(16);
  for (unsigned line = 0; line < 3; ++line)
    inputs_.line_select = static_cast<std::uint16_t>(inputs_.line_select << 4 | (1 + below(8)));
  reset_at_ = 12 + below(30);  // released there
  bus_at_ = reset_at_ + kAwake;
}

void MotorTraffic::run(Board& board, Tick end, Tick batch) {
  board.set_inputs(inputs_);
  while (board.now() < end) {
    const Tick target = std::min(next(), end);
    while (board.now() < target) board.run_until(board.now() + std::min(batch, target - board.now()));
    if (target == end) break;
    if (reset_at_ == target) {
      inputs_.rst_n = !inputs_.rst_n;
      if (!inputs_.rst_n) inputs_.pwr_good = true;
      started_ = 0;
      if (inputs_.rst_n) awake_at_ = target + kAwake;
      reset_at_ = inputs_.rst_n ? kNever : target + 1 + below(60);
    }
    if (bus_at_ == target) bus_step();
    board.set_inputs(inputs_);
    for (Ic& ic : ics_)
      if (ic.at == target) pins_step(ic, board);
  }
}

Tick MotorTraffic::next() const {
  Tick t = std::min(bus_at_, reset_at_);
  for (const Ic& ic : ics_) t = std::min(t, ic.at);
  return t;
}

// One channel moves, or several at one edge.
void MotorTraffic::pins_step(Ic& ic, Board& board) {
  const unsigned n = below(kChannels);
  const bool several = one_in(4);
  for (unsigned i = 0; i < kChannels; ++i)
    if (i == n || (several && !one_in(3))) move(ic.channels[i], ic.pins.pins[i]);
  if (one_in(3)) ic.pins.adc_a = static_cast<std::uint8_t>(below(16));
  if (one_in(3)) ic.pins.adc_b = static_cast<std::uint8_t>(below(16));
  board.set_motor_inputs(ic.index, ic.pins);
  ic.at += 1 + (ic.channels[n].speed + below(10)) / kChannels;
}

void MotorTraffic::move(Channel& c, std::uint16_t& pins) {
  if (one_in(30)) c.up = !c.up;
  if (one_in(40)) c.speed = one_in(3) ? 1 + below(20) : 20 + up_to(4 * options_.pins_pause);
  constexpr unsigned kHall[6] = {4, 6, 2, 3, 1, 5}, kQuadrature[4] = {0, 1, 3, 2};  // {C, B, A}
  c.place = (c.place + (c.up ? 1u : 11u)) % 12;
  const unsigned abc = c.hall ? kHall[c.place % 6] : kQuadrature[c.place % 4] | (one_in(4) ? 4u : 0u);
  pins = static_cast<std::uint16_t>((pins & ~7u) | abc);
  if (one_in(6)) pins = static_cast<std::uint16_t>(pins ^ 1u << below(kChannelPins));
}

void MotorTraffic::bus_step() {
  switch (bus_step_++) {
    case 0:
      if (bus_at_ < awake_at_) {  // or the first word after the reset, which is the clocks', would be lost
        bus_at_ = awake_at_;
        bus_step_ = 0;
        break;
      }
      ++accesses_;
      if (tripped_accesses_ % 5 == 1) {
        control(ics_[below(static_cast<std::uint32_t>(ics_.size()))], below(kChannels), one_in(2));
        ++writes_tripped_;
      } else if (!start_access()) {
        choose_access();
      }
      bus_at_ += 3 + below(4);
      break;
    case 1:
      (writing_ ? inputs_.pa_wr_n : inputs_.pa_rd_n) = false;
      bus_at_ += 9 + below(one_in(12) ? 3000 : 6);  // now and then so long that the word changes under a read
      break;
    case 2:
      inputs_.pa_wr_n = inputs_.pa_rd_n = true;
      bus_at_ += 3 + below(5);
      break;
    default:
      if (one_in(2)) inputs_.pa_aa = 0;
      bus_step_ = 0;
      bus_at_ += started_ < 6 * ics_.size() ? 1 : 1 + up_to(one_in(10) ? options_.long_pause : options_.bus_pause);
      if (options_.fail_every != 0) fail_or_recover();
      if (reset_at_ != kNever) break;
      if (options_.reset_one_in != 0 && one_in(options_.reset_one_in)) {
        reset_at_ = bus_at_ + below(20);
      } else if (bus_at_ >= options_.silent_at ||
                 (options_.may_trip && options_.reset_one_in != 0 && one_in(10 * options_.reset_one_in))) {
        options_.silent_at = kNever;
        options_.may_trip = false;
        bus_at_ += kTripTime;
        reset_at_ = bus_at_ + below(200'000);
      }
      break;
  }
}

// The watchdog trips while everything goes on.
void MotorTraffic::fail_or_recover() {
  if (tripped_accesses_ > 0 && --tripped_accesses_ == 0 && reset_at_ == kNever) reset_at_ = bus_at_ + 1 + below(20);
  if (accesses_ % options_.fail_every != 0 || reset_at_ != kNever) return;
  inputs_.pwr_good = false;
  tripped_accesses_ = kTrippedAccesses;
}

// After a reset the clocks come first and every channel is put to use, so that there is something to see.
bool MotorTraffic::start_access() {
  const unsigned count = static_cast<unsigned>(ics_.size()), step = started_;
  if (step >= 6 * count) return false;
  ++started_;
  Ic& ic = ics_[step < 2 * count ? step / 2 : (step - 2 * count) / kChannels];
  if (step >= 2 * count)
    control(ic, step % kChannels, true);
  else if (!options_.moving_clocks)
    write(ic, true, kGlobal, &ic == &ics_.front() ? kOwnClocks : kOwnClocks | kInputs);
  else if (step % 2 == 0)
    write(ic, true, kGlobal, first_clock_word(ic));
  else if (step == 1 && options_.macro_drives)
    write_at(macro_ics_.front() + regs::macro_ic::kClockControl.address, true, clock_word(true) & ~kInputs);
  else if (step == 3 && options_.macro_drives)
    write_at(macro_ics_.front() + regs::macro_ic::kPwmControl.address, true, pwm_word());
  else
    write(ic, true, kPwm, (40 + below(700)) << 8 | below(4));
  return true;
}

// Short periods; one IC mostly drives PHASE and SERVO, the others mostly follow.
std::uint32_t MotorTraffic::clock_word(bool drives) {
  const std::uint32_t dividers = one_in(3) ? below(4096) : below(4) | below(4) << 3 | below(3) << 6 | below(3) << 9;
  const std::uint32_t external = one_in(20) ? below(4) : (drives ? 0 : 3);
  return dividers | external << 12 | below(3) << 16 | below(4) << 20;
}

// The lowest one drives them for certain, or the first MACRO IC does and none else.
std::uint32_t MotorTraffic::first_clock_word(const Ic& ic) {
  const bool lowest = &ic == &ics_.front() && !options_.macro_drives;
  const std::uint32_t word = clock_word(lowest);
  return lowest ? word & ~kInputs : options_.macro_drives ? word | kInputs : word;
}

std::uint32_t MotorTraffic::pwm_word() {
  const std::uint32_t max_count = one_in(4) ? below(40) : one_in(6) ? 200 + below(3000) : below(700);
  return max_count << 8 | (one_in(2) ? below(3) : below(30));
}

// `in_use`: counts its encoder or its own PFM pulses, with the amplifier enabled.
void MotorTraffic::control(Ic& ic, unsigned channel, bool in_use) {
  std::uint32_t word = below(1u << 24);
  if (in_use)
    word = (word & ~0xFu) | 0x4000 | (one_in(3) ? 0x800008 : 3 | below(2) << 2);
  else if (one_in(2))
    word = (word & ~0xFu) | 3 | below(2) << 2;
  ic.channels[channel].hall = (word & 0xB) == 0xB;
  if (!one_in(6)) word &= ~0x400u;   // counter reset
  if (one_in(2)) word &= ~0x40000u;  // hardware 1/T
  write(ic, true, 8 * channel + kControl, word);
}

// DAC and PFM words of any size, PWM commands about 0; both signs.
std::uint32_t MotorTraffic::output_word() {
  const std::uint32_t size = one_in(3) ? below(2000) << 8 : below(one_in(2) ? 0x800000 : 60'000);
  return (one_in(2) ? size : 0u - size) & 0xFFFFFF;
}

void MotorTraffic::choose_access() {
  if (!macro_ics_.empty() && one_in(8)) return choose_macro_access();
  Ic& ic = ics_[below(static_cast<std::uint32_t>(ics_.size()))];
  const unsigned n = below(kChannels), at = 8 * n;
  switch (below(17)) {
    case 0:
      if (!options_.moving_clocks) return write(ic, true, kDacStrobe, below(1u << 24));
      if (one_in(4)) return write(ic, true, kGlobal, clock_word(&ic == &ics_.front() && !options_.macro_drives));
      return write(ic, true, kPwm, pwm_word());
    case 1:
      return write(ic, true, one_in(2) ? kDacStrobe : kAdcStrobe, below(1u << 24));
    case 2:
    case 3:
      return control(ic, n, one_in(2));
    case 4:
    case 5:
    case 6:
      return write(ic, false, at + kOutA + below(3), output_word());
    case 7:
    case 8:  // positions stay near 0 between resets
      return write(ic, one_in(2), at + kCompare, (one_in(2) ? below(200) - 100 : below(40)) & 0xFFFFFF);
    case 9:
      return write(ic, true, at + kIncrement, below(one_in(2) ? 10 : 40));
    case 10:
      return write(ic, false, at + below(2), below(0x1000));
    case 11:
      return write(ic, true, at, below(0x1000));
    case 12:
      return read(ic, true, at + kCapture);
    case 13:  // the watchdog strobe, X:$070011
      write(ic, true, 0, below(1u << 24));
      inputs_.pa_addr = 0x070011;
      inputs_.pa_aa = 0;
      return;
    default:
      return read(ic, one_in(2), below(32));
  }
}

// Any word of a MACRO IC, those that are built more often. Now and then it drives the clocks; the one whose
// clocks they are goes on, or all would stand still until a reset, which may be a whole life away.
void MotorTraffic::choose_macro_access() {
  namespace map = regs::macro_ic;
  constexpr std::uint32_t kBuilt[] = {0x00, 0x02, map::kClockControl.address, map::kPwmControl.address, 0x0E, 0x0F,
                                      0x15, 0x1D};
  const std::uint32_t offset = one_in(3) ? below(64) : kBuilt[below(std::size(kBuilt))];
  const std::uint32_t address = macro_ics_[below(static_cast<std::uint32_t>(macro_ics_.size()))] + offset;
  const bool x = one_in(2), clock = x && offset == map::kClockControl.address,
             pwm = x && offset == map::kPwmControl.address;
  if (one_in(3) || ((clock || pwm) && !options_.moving_clocks)) return read_at(address, x);
  if (!clock) return write_at(address, x, pwm ? pwm_word() : below(1u << 24));
  const bool drives = one_in(8);
  write_at(address, x, clock_word(drives || (options_.macro_drives && address == macro_ics_.front() + offset)));
}

void MotorTraffic::write_at(std::uint32_t address, bool x, std::uint32_t word) {
  read_at(address, x);
  writing_ = true;
  inputs_.pa_wdata = word;
}

void MotorTraffic::read_at(std::uint32_t address, bool x) {
  writing_ = false;
  inputs_.pa_addr = address;
  inputs_.pa_x = x;
  inputs_.pa_aa = 2;
}

}  // namespace brick
