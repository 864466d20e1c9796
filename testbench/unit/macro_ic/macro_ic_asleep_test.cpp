// A MACRO IC of the model that nobody asks catches up with the clocks and jumps over periods of them in which it
// repeats (systemc/servo_ic/clock_follower.h). Where it is then is arithmetic on servo-ic:5.1/6, and where one is that
// executed every edge.
#include <gtest/gtest.h>

#include "systemc/macro_ic/macro_ic.h"
#include "systemc/servo_ic/clock_history.h"
#include "testbench/unit/servo_ic/clock_words.h"

namespace brick {
namespace {

constexpr unsigned kClock = 0x0C;
constexpr Tick kWay = 2 * 6527 + 3;  // of the triangle, from end to end

class Pair {
 public:
  // PHASE from outside, and SERVO with it: rise n acts at tick `first + (n - 1) period`, three behind the pin, and the
  // pin falls when 6528 more have passed. A triangle that this rise has aligned is then at 0, its place behind a reset.
  Pair(Tick first, Tick period, unsigned rises) {
    constexpr Tick kSync = 3, kHigh = kSync + 6528 + 1;
    for (MacroIc* ic : {&asleep_, &awake_}) {
      ic->reset(0);
      ic->set_pins(true, true);
    }
    for (unsigned rise = 1; rise <= rises; ++rise) {
      const Tick at = first - kSync + (rise - 1) * period;
      edge(at - period + kHigh, false);
      edge(at, true);
      if (rise == 2) ask();  // somebody reads, once
    }
  }
  // Both become the source and must take PHASE with the first rise of their own clock. It is high when they do, so it
  // falls behind the first turnaround and rises at the second. The last one before was at `turn`.
  void expect_phase(Tick turn) {
    const Tick written = next_ref_edge(now_ + 100);
    awake_.advance(written);
    now_ = written;
    ask();
    const Tick expected = turn + ((written - turn) / kWay + 2) * kWay;
    EXPECT_EQ(takes_phase(awake_), expected) << "kept awake";
    EXPECT_EQ(takes_phase(asleep_), expected) << "left alone";
  }

 private:
  void edge(Tick at, bool level) {
    awake_.advance(at);
    awake_.set_pins(level, level);
    history_.push({at, level, level});
    now_ = at;
  }
  void ask() { asleep_.catch_up(history_, now_); }
  Tick takes_phase(MacroIc& ic) {
    ic.write(true, kClock, clock_word(0, 3, 0));
    Tick at = now_;
    while (!ic.phase_oe() && at < now_ + 3 * kWay) ic.advance(++at);
    return at;
  }

  MacroIc asleep_{sc_core::sc_gen_unique_name("asleep")}, awake_{sc_core::sc_gen_unique_name("awake")};
  ClockHistory history_;
  Tick now_ = 0;
};

// The triangle turns at 6529 and each 13057 ticks later. A rise each 15000 ticks, 414 behind a turnaround at first, is
// never within 8 ticks of one: only the fourth moves it, then the eighth and so on.
TEST(MacroIcAsleep, APhaseThatAlignsEachFourthTimeDoesNotRepeat) {
  constexpr Tick kFirst = 20'000, kPeriod = 15'000;
  for (const unsigned rises : {24u, 25u, 26u, 27u}) {
    SCOPED_TRACE(rises);
    Pair(kFirst, kPeriod, rises).expect_phase(kFirst + (rises / 4 * 4 - 1) * kPeriod);
  }
}

// A rise at each second turnaround, or a few ticks behind: all periods are the same.
TEST(MacroIcAsleep, APhaseInStepWithTheTriangleRepeats) {
  for (const Tick late : {0, 5}) {
    for (const unsigned rises : {5u, 24u, 25u, 1000u}) {
      SCOPED_TRACE(rises);
      const Tick first = 6529 + kWay + late, period = 2 * kWay + late;
      Pair(first, period, rises).expect_phase(first + (rises - 1) * period);
    }
  }
}

}  // namespace
}  // namespace brick
