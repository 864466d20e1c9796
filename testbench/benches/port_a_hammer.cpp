// port-a-hammer: the board's own devices among others on Port A, cycles back to back at the limits of every row, each
// line with a delay of its own and near edges taken early or late. The others have the same addresses: only their
// selects differ. What is for the board is neither lost nor torn; no write to another device lands here: every word of
// the RAM and all that keep what is written into them are looked at. D is driven in the board's own reads, from the
// edge that the rules name to the end of /RD, and at no other time (port_a_drive.h). No firmware: the bench is the bus
// master.
#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/core/motor_pins.h"
#include "testbench/benches/benches.h"
#include "testbench/benches/port_a_driver.h"

namespace brick {
namespace {

constexpr unsigned kCycles = 3000;               // at each clock
constexpr std::uint8_t kMemory = 1, kFlash = 8;  // AA0, AA3
constexpr unsigned kNear = kCycles / 8;          // cycles of others right behind an own read, of all clocks

// Wait states of host-bus:2.5.
struct Clock {
  unsigned i52, gate, ram, latch;
};
constexpr Clock kClocks[] = {{0, 8, 4, 15},  {3, 8, 4, 15},   {5, 8, 3, 15},   {7, 8, 3, 15},
                             {9, 10, 4, 15}, {11, 16, 7, 31}, {14, 16, 7, 31}, {15, 16, 7, 31}};
constexpr const Clock& kFastest = kClocks[std::size(kClocks) - 1];  // the watchdog gives time for no more

class PortAHammer {
 public:
  explicit PortAHammer(BenchContext& b) : b_(b), driver_(b.machine, b.seed) {
    PinSkew skew(b.seed);
    if (b.negative)
      for (unsigned line = kAaLine; line < kIntLine; ++line) skew.set(line, 4 * PinSkew::kMost);
    driver_.set_skew(skew);
    namespace ch = regs::servo_channel;
    const auto gate = [this](unsigned ic, unsigned offset, const regs::Register& word) {
      words_.push_back({regs::kGateIcs[ic].base + offset + word.address, word.space == 'X', 2, 0xFFFFFF, 0});
    };
    for (unsigned ic = 0; ic < 2; ++ic) {
      for (const regs::Register* word : {&regs::servo_ic::kDacStrobe, &regs::servo_ic::kAdcStrobe}) gate(ic, 0, *word);
      for (unsigned channel = 0; channel < kChannels; ++channel)
        for (const regs::Register* word : {&ch::kOutA, &ch::kOutB, &ch::kOutC, &ch::kCompareIncrement})
          gate(ic, 8 * channel, *word);
    }
    words_.push_back({regs::board_latches::kHostSignals.address, true, 0, 0xF, 0});
    registers_ = static_cast<unsigned>(words_.size());
    for (unsigned i = 0; i < b_.board.dpram_words; ++i)
      words_.push_back({regs::kDpramBase + i / 2, i % 2 != 0, 4, 0xFFFF, 0});
  }

  void run() {
    b_.machine.run_until(600);  // reset is over
    begin(kFastest);
    for (std::size_t i = registers_; i < words_.size(); ++i) words_[i].value = driver_.read(place(words_[i], kFastest));
    for (const Clock& clock : kClocks) at_clock(clock);
    whole_ram();
    b_.report.reached("cycles of others right behind a read of the board", driver_.drive().met(), kNear);
    b_.report.step("clocks that /TA added", driver_.stretched() > 0, fmt::format("{}", driver_.stretched()));
  }

 private:
  struct Word {
    std::uint32_t address;
    bool x;
    std::uint8_t aa;
    std::uint32_t mask, value;
  };
  using Place = PortADriver::Place;

  unsigned below(unsigned count) { return driver_.random() % count; }

  void begin(const Clock& clock) {
    driver_.set_clock(clock.i52);
    driver_.rest();
    driver_.wait_until(b_.machine.now_fs() + tick_to_fs(30 + below(3)) + driver_.random() % 8'000'000);
  }

  // Half of all cycles are at words that another one has just been at, too.
  std::size_t any() {
    std::size_t& recent = recent_[below(static_cast<unsigned>(recent_.size()))];
    if (below(2) == 0) recent = below(2) == 0 ? below(registers_) : registers_ + below(b_.board.dpram_words);
    return recent;
  }

  void at_clock(const Clock& clock) {
    begin(clock);
    Comparison same;
    unsigned others = 0;
    for (std::size_t i = 0; i < registers_; ++i) write(words_[i], clock);
    for (unsigned i = 0; i < kCycles; ++i) {
      Word& word = words_[any()];
      switch (below(4)) {
        case 0:
          write(word, clock);
          break;
        case 1:
          check(same, word, clock);
          break;
        default:
          ++others;
          other(word, clock);
          if (below(2) == 0) check(same, word, clock);  // the address stands, the selects alone move
          break;
      }
      if (below(8) == 0) driver_.wait_until(driver_.free_at() + driver_.random() % 40'000'000);
    }
    for (std::size_t i = 0; i < registers_; ++i) check(same, words_[i], clock);
    driver_.rest();
    d(same);
    same.equal("reads of a bus that nobody drove", driver_.floating() - floating_, 0);
    floating_ = driver_.floating();
    b_.report.step(fmt::format("I52={}", clock.i52), same, kCycles / 8,
                   fmt::format("{} words, {} cycles of other devices", same.made(), others));
  }

  void d(Comparison& same) {
    const PortADrive& drive = driver_.drive();
    same.equal(fmt::format("D, {}, faults", drive.text()), drive.faults() - faults_, 0);
    faults_ = drive.faults();
  }

  void whole_ram() {
    Comparison same;
    for (std::size_t i = registers_; i < words_.size(); ++i) check(same, words_[i], kFastest);
    driver_.rest();
    d(same);
    b_.report.step("every word of the RAM", same, b_.board.dpram_words, fmt::format("{} words", same.made()));
  }

  // Of ours as many wait states as host-bus:2.5 has, or up to 8 more.
  Place place(const Word& word, const Clock& clock) {
    const bool ram = word.aa == 4;
    const unsigned least = word.aa == 2 ? clock.gate : ram ? clock.ram : clock.latch, most = ram ? 7 : 31;
    const unsigned ws = below(4) == 0 ? std::min(most, least + below(9)) : least;
    return {word.address, word.x, word.aa, false, ws};
  }
  void write(Word& word, const Clock& clock) {
    word.value = driver_.random() & word.mask;
    driver_.write(place(word, clock), word.value);
  }
  void check(Comparison& same, const Word& word, const Clock& clock) {
    same.word(fmt::format("{}:${:06X}", word.x ? 'X' : 'Y', word.address), driver_.read(place(word, clock)) & word.mask,
              word.value);
  }
  // As short as the clock lets it be (host-bus:2.2/5, host-bus:2.6/9), longer than any of ours, or of 4 to 9 ticks: it
  // ends where the board looks at address and strobe of an access (host-bus:2.6/1).
  void other(const Word& word, const Clock& clock) {
    const bool write = below(2) != 0;
    const bool one = clock.i52 < 15 && port_a_limits(clock.i52, 1, write).setup >= 2 * driver_.aperture();
    const unsigned least = one ? 1 : 2;
    const unsigned looked = (4 + below(6)) * (clock.i52 + 1) / 12;  // a clock is 12 / (I52 + 1) ticks
    const unsigned kind = below(3), ws = kind == 0   ? least + below(3)
                                         : kind == 1 ? least + below(30)
                                                     : std::max(least, looked);
    driver_.foreign({word.address, word.x, below(2) != 0 ? kMemory : kFlash, false, ws}, write,
                    driver_.random() & 0xFFFFFF);
  }

  BenchContext& b_;
  PortADriver driver_;
  std::vector<Word> words_;
  unsigned registers_ = 0;  // how many of them are no words of the RAM
  std::array<std::size_t, 16> recent_{};
  unsigned floating_ = 0, faults_ = 0;
};

}  // namespace

Bench port_a_hammer_bench() {
  return {"port-a-hammer",
          "the board's devices among others on Port A, each line with a delay of its own",
          {"chip selects 34 ns late", "I52=*", "expected "},
          [](BenchContext& b) { PortAHammer(b).run(); },
          kServoIcs01,
          nullptr,
          "geobrick-lv-8",
          false};
}

}  // namespace brick
