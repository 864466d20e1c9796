// port-a-hammer: the board's own devices among others on Port A, cycles back to back at the limits of every row, each
// line with a delay of its own and near edges taken early or late. The others have the same addresses: only their
// selects differ. No write to another device lands here, no read of one drives D, and what is for the board is neither
// lost nor torn. No firmware: the bench is the bus master.
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

// Wait states of host-bus:2.5.
struct Clock {
  unsigned i52, gate, ram, latch;
};
constexpr Clock kClocks[] = {{0, 8, 4, 15},  {3, 8, 4, 15},   {5, 8, 3, 15},   {7, 8, 3, 15},
                             {9, 10, 4, 15}, {11, 16, 7, 31}, {14, 16, 7, 31}, {15, 16, 7, 31}};

class PortAHammer {
 public:
  explicit PortAHammer(BenchContext& b) : b_(b), driver_(b.machine, b.seed) {
    PinSkew skew(b.seed);
    if (b.negative)
      for (unsigned line = kAaLine; line < kIntLine; ++line) skew.set(line, 4 * PinSkew::kMost);
    driver_.set_skew(skew);
    for (unsigned ic = 0; ic < 2; ++ic)
      for (unsigned channel = 0; channel < kChannels; ++channel)
        for (const regs::Register* word : {&regs::servo_channel::kOutA, &regs::servo_channel::kOutB})
          words_.push_back({regs::kGateIcs[ic].base + 8 * channel + word->address, false, 2, 0xFFFFFF, 0});
    words_.push_back({regs::board_latches::kHostSignals.address, true, 0, 0xF, 0});
    for (unsigned i = 0; i < 12; ++i) words_.push_back({regs::kDpramBase + 97 * i, i % 2 == 0, 4, 0xFFFF, 0});
  }

  void run() {
    b_.machine.run_until(600);  // reset is over
    for (const Clock& clock : kClocks) at_clock(clock);
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

  void at_clock(const Clock& clock) {
    driver_.set_clock(clock.i52);
    driver_.rest();
    driver_.wait_until(b_.machine.now_fs() + tick_to_fs(30 + below(3)) + driver_.random() % 8'000'000);
    Comparison same;
    unsigned others = 0, driven = 0;
    for (Word& word : words_) write(word, clock);
    for (unsigned i = 0; i < kCycles; ++i) {
      Word& word = words_[below(static_cast<unsigned>(words_.size()))];
      switch (below(4)) {
        case 0:
          write(word, clock);
          break;
        case 1:
          check(same, word, clock);
          break;
        default:
          ++others;
          driven += other(word, clock) ? 1 : 0;
          break;
      }
      if (below(8) == 0) driver_.wait_until(driver_.free_at() + driver_.random() % 40'000'000);
    }
    for (const Word& word : words_) check(same, word, clock);
    driver_.rest();
    same.equal("cycles of other devices in which the board drove D", driven, 0);
    same.equal("reads of a bus that nobody drove", driver_.floating() - floating_, 0);
    floating_ = driver_.floating();
    b_.report.step(fmt::format("I52={}", clock.i52), same, kCycles / 8,
                   fmt::format("{} words, {} cycles of other devices", same.made(), others));
  }

  Place place(const Word& word, const Clock& clock) const {
    return {word.address, word.x, word.aa, false, word.aa == 2 ? clock.gate : word.aa == 4 ? clock.ram : clock.latch};
  }
  void write(Word& word, const Clock& clock) {
    word.value = driver_.random() & word.mask;
    driver_.write(place(word, clock), word.value);
  }
  void check(Comparison& same, const Word& word, const Clock& clock) {
    same.word(fmt::format("{}:${:06X}", word.x ? 'X' : 'Y', word.address), driver_.read(place(word, clock)) & word.mask,
              word.value);
  }
  // As short as the clock lets it be (host-bus:2.2/5, host-bus:2.6/9), or longer than any of ours.
  bool other(const Word& word, const Clock& clock) {
    const bool write = below(2) != 0;
    const bool one = clock.i52 < 15 && port_a_limits(clock.i52, 1, write).setup >= 2 * driver_.aperture();
    const unsigned least = one ? 1 : 2;
    const unsigned ws = below(3) != 0 ? least + below(3) : least + below(30);
    return driver_.foreign({word.address, word.x, below(2) != 0 ? kMemory : kFlash, false, ws}, write,
                           driver_.random() & 0xFFFFFF);
  }

  BenchContext& b_;
  PortADriver driver_;
  std::vector<Word> words_;
  unsigned floating_ = 0;
};

}  // namespace

Bench port_a_hammer_bench() {
  return {"port-a-hammer",
          "the board's devices among others on Port A, each line with a delay of its own",
          {"chip selects 34 ns late", "I52=*", "expected $"},
          [](BenchContext& b) { PortAHammer(b).run(); },
          kServoIcs01,
          nullptr,
          "geobrick-lv-8",
          false};
}

}  // namespace brick
