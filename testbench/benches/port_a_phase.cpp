// port-a-phase: the board's side of Port A at the limits of its timing, with the CPU clock at every phase to clk_ref.
// No firmware: the bench is the bus master. What was written is read back, once, and nothing else has changed; what a
// read does is done once, and what happens meanwhile is either shown or kept.
#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/core/motor_pins.h"
#include "testbench/benches/benches.h"
#include "testbench/benches/port_a_driver.h"

namespace brick {
namespace {

constexpr TimeFs kRefPeriod = tick_to_fs(kTicksPerRef);
constexpr unsigned kSteps = 128;  // of the phase: 0.2 ns each
constexpr unsigned kLeastStretched = 100;
constexpr Tick kSettled = 75;  // six periods of SCLK: a pin is through the filter

// Wait states of host-bus:2.5. With --skew nothing is promised of the RAM above I52 = 15.
constexpr unsigned kMostSkewed = 15;
struct Clock {
  unsigned i52, gate, ram, latch;
};
constexpr Clock kClocks[] = {{7, 8, 3, 15}, {9, 10, 4, 15}, {15, 16, 7, 31}, {23, 24, 7, 31}, {31, 31, 7, 31}};

class PortAPhase {
 public:
  explicit PortAPhase(BenchContext& b) : b_(b), driver_(b.machine, b.seed) {
    if (b.negative) driver_.spoil_data(48 * kFsPerNs);
  }

  void run() {
    b_.machine.run_until(600);  // reset is over
    for (const Clock& clock : kClocks) {
      if (b_.machine.skew().on() && clock.i52 > kMostSkewed) break;
      clock_ = clock;
      driver_.set_clock(clock.i52);
      gate_ics();
      latches();
      dual_ported_ram();
      host_port();
      capture();
    }
    const Aperture::Counts& c = driver_.moves();
    b_.report.step("moves within a nanosecond of an edge", c.early > 1000 && c.late > 1000 && c.split > 1000,
                   fmt::format("{} of {}: {} early, {} late, {} of a bus line by line", c.inside(), c.moves, c.early,
                               c.late, c.split));
    b_.report.step("clocks that /TA added", driver_.stretched() >= kLeastStretched,
                   fmt::format("{}, {} at least", driver_.stretched(), kLeastStretched));
  }

 private:
  using Place = PortADriver::Place;

  std::string name(const std::string& what) const { return fmt::format("I52={}, {}", clock_.i52, what); }

  // The next cycle begins at this phase, some time from now.
  void begin(unsigned phase, Tick later = 6) {
    const Tick ref = ((b_.machine.now() + later) / kTicksPerRef + 1) * kTicksPerRef;
    driver_.wait_until(tick_to_fs(ref) + kRefPeriod * phase / kSteps);
  }
  void judge(const std::string& what, const Comparison& same, unsigned least) {
    const unsigned phases = std::min(driver_.least_phase(false), driver_.least_phase(true));
    Comparison all = same;
    all.within("times that the rarest phase was seen", phases, 1, INT32_MAX);
    all.equal("reads of a bus that nobody drove", driver_.floating(), 0);
    b_.report.step(name(what), all, least,
                   fmt::format("{} words, every phase of 0.4 ns {} times or more", same.made(), phases));
    driver_.forget_phases();
  }

  // Random words to and fro, cycles back to back; then all of them once more.
  void memory(const char* what, const std::vector<Place>& places, std::uint32_t mask) {
    Comparison same;
    std::vector<std::uint32_t> expected(places.size());
    const auto where = [&](std::size_t i) {
      return fmt::format("{}:${:06X}", places[i].x ? 'X' : 'Y', places[i].address);
    };
    const auto write = [&](std::size_t i) { driver_.write(places[i], expected[i] = driver_.random() & 0xFFFFFF); };
    const auto check = [&](std::size_t i) { same.word(where(i), driver_.read(places[i]), expected[i] & mask); };
    const auto any = [&] { return driver_.random() % places.size(); };
    begin(0);
    for (std::size_t i = 0; i < places.size(); ++i) write(i);
    for (unsigned phase = 0; phase < 2 * kSteps; ++phase) {
      begin(phase / 2);
      const std::size_t first = any(), second = any();
      if (phase % 2 == 0) {
        write(first);
        write(second);
        check(first);
        check(any());
        write(first);
        check(first);
      } else {
        check(first);
        check(second);
        write(first);
        write(second);
        write(first);
        check(second);
        check(first);
      }
    }
    for (std::size_t i = 0; i < places.size(); ++i) check(i);
    driver_.rest();
    judge(what, same, 7 * kSteps);
  }

  // Output words of all channels: 24 bits, and they do nothing while the channels count PFM and DAC off.
  void gate_ics() {
    std::vector<Place> places;
    for (unsigned ic = 0; ic < 2; ++ic)
      for (unsigned channel = 0; channel < kChannels; ++channel)
        for (const regs::Register* word :
             {&regs::servo_channel::kOutA, &regs::servo_channel::kOutB, &regs::servo_channel::kOutC})
          places.push_back({regs::kGateIcs[ic].base + 8 * channel + word->address, false, 2, false, clock_.gate});
    memory("gate ICs", places, 0xFFFFFF);
  }

  void latches() {
    memory("latches", {{regs::board_latches::kHostSignals.address, true, 0, false, clock_.latch}}, 0xF);
  }

  void dual_ported_ram() {
    std::vector<Place> places;
    for (unsigned i = 0; i < 16; ++i) places.push_back({regs::kDpramBase + 97 * i, i % 2 == 0, 4, false, clock_.ram});
    memory("dual-ported RAM", places, 0xFFFF);
  }

  // Two characters wait; each read takes one. A word is written once: when the host has taken it no other follows.
  void host_port() {
    namespace hsr = regs::hi08::hsr;
    const auto place = [&](const regs::Register& word) {
      return Place{word.address & 0x7F, true, 0, true, std::max(7u, clock_.i52)};
    };
    const Place horx = place(regs::hi08::kHorx), hotx = place(regs::hi08::kHotx), status = place(regs::hi08::kHsr);
    Comparison same;
    for (unsigned phase = 0; phase < kSteps; phase += 2) {
      const std::uint32_t in[] = {driver_.random() & 0xFF, driver_.random() & 0xFF}, out = driver_.random() & 0xFFFFFF;
      for (const std::uint32_t c : in) b_.bus.io_write(regs::host_io::kData7, static_cast<std::uint8_t>(c));
      begin(phase);
      for (const std::uint32_t c : in) same.word("HORX", driver_.read(horx), c);
      same.equal("HRDF after two reads", hsr::kHrdf.is_set(driver_.read(status)), false);
      driver_.rest();
      begin(phase);
      driver_.write(hotx, out);
      driver_.rest();
      same.equal("character to the host", b_.bus.io_read(regs::host_io::kData7), out & 0xFF);
      same.equal("characters after it", b_.bus.port_status() & HostBus::kRxdf, 0);
    }
    b_.report.step(name("host port"), same, 320, fmt::format("{} words and flags", same.made()));
    driver_.forget_phases();
  }

  void flag(bool level) {
    std::uint16_t& pins = b_.machine.motor_inputs()[0].pins[0];
    pins = static_cast<std::uint16_t>(level ? pins | 1u << kHmfl : pins & ~(1u << kHmfl));
    b_.machine.apply_motor_inputs();
  }
  void count() {                                        // one up: a quarter cycle, A before B
    constexpr std::array<unsigned, 4> kAb{0, 1, 3, 2};  // {B, A}
    quarter_ = (quarter_ + 1) % 4;
    std::uint16_t& pins = b_.machine.motor_inputs()[0].pins[0];
    pins = static_cast<std::uint16_t>((pins & ~3u) | kAb[quarter_]);
    b_.machine.apply_motor_inputs();
    counted_ = (counted_ + 1) & 0xFFFFFF;
  }

  // The home flag rises at any time around a read of the captured position: the read shows the new position, and
  // CAPT is clear, or it shows the old one, and CAPT is set. A capture is never lost and never counted twice.
  void capture() {
    namespace control = regs::servo_channel::control;
    const auto place = [&](const regs::Register& word) {
      return Place{regs::kGateIcs[0].base + word.address, word.space == 'X', 2, false, clock_.gate};
    };
    const Place position = place(regs::servo_channel::kFlagPosition), status = place(regs::servo_channel::kStatus);
    const auto captured = [&] { return regs::servo_channel::status::kCaptured.is_set(driver_.read(status)); };
    const auto settle = [&] { driver_.wait_until(driver_.free_at() + tick_to_fs(kSettled)); };
    begin(0);
    driver_.write(place(regs::servo_channel::kControl), control::kDecode.at(regs::decode::kX4Cw) |
                                                            control::kCaptureSource.at(regs::capture_source::kFlag) |
                                                            control::kFlagSelect.at(regs::flag_select::kHmfl));
    Comparison same;
    unsigned shown = 0, kept = 0;
    for (unsigned phase = 0; phase < 2 * kSteps; ++phase) {
      driver_.rest();
      const std::uint32_t old = counted_;
      count();
      begin(phase / 2, kSettled);
      // The capture comes 26 to 38 ticks after the flag: two flip-flops, and SCLK is 12 ticks. The sample comes 6 to 9
      // after the strobe.
      driver_.at(fs_to_tick(driver_.free_at()) - 16 - static_cast<Tick>(driver_.random() % 17), [this] { flag(true); });
      const std::uint32_t word = driver_.read(position);
      settle();
      const bool still = captured();
      same.judged(fmt::format("phase {}", phase),
                  word == (still ? old : counted_)
                      ? ""
                      : fmt::format("the read shows ${:06X}, CAPT is {}; expected ${:06X} and 0, or ${:06X} and 1",
                                    word, still ? 1 : 0, counted_, old));
      ++(still ? kept : shown);
      same.word("position of the capture", driver_.read(position), counted_);
      same.equal("CAPT after the second read", captured(), false);
      driver_.rest();
      flag(false);
      settle();
    }
    same.within("captures that the read has shown", shown, kSteps / 8, INT32_MAX);
    same.within("captures that came later and were kept", kept, kSteps / 8, INT32_MAX);
    b_.report.step(
        name("captured position"), same, 6 * kSteps,
        fmt::format("{} captures: {} shown by the read they met, {} kept for the next", shown + kept, shown, kept));
    driver_.forget_phases();
  }

  BenchContext& b_;
  PortADriver driver_;
  Clock clock_{};
  unsigned quarter_ = 3;  // of the encoder: B is high when nothing is connected
  std::uint32_t counted_ = 0;
};

}  // namespace

Bench port_a_phase_bench() {
  return {"port-a-phase",
          "Port A at the limits of its timing, the CPU clock at every phase to the board's",
          {"write data gone 48 ns before /WR rises", "I52=7, gate ICs", "expected $"},
          [](BenchContext& b) { PortAPhase(b).run(); },
          kServoIcs01,
          nullptr,
          "geobrick-lv-8",
          false};
}

}  // namespace brick
