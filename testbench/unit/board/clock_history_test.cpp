// What the list of the clocks' edges says of itself (systemc/servo_ic/clock_history.h): whether they repeat, from which
// edge on, and when it is time to begin a new one.
#include "systemc/servo_ic/clock_history.h"

#include <gtest/gtest.h>

#include <random>

#include "testbench/unit/random_seed.h"

namespace brick {
namespace {

// PHASE turns each 100 ticks, SERVO with each `servo`th fall of it; without SERVO: 0.
class RegularClocks {
 public:
  explicit RegularClocks(unsigned servo) : servo_every_(servo) {}
  ClockHistory::Edge next() {
    tick_ += 100;
    phase_ = !phase_;
    if (servo_every_ != 0 && !phase_ && ++falls_ % servo_every_ == 0) servo_ = !servo_;
    return {tick_, phase_, servo_};
  }
  void late(Tick by) { tick_ += by; }

 private:
  unsigned servo_every_, falls_ = 0;
  Tick tick_ = 0;
  bool phase_ = true, servo_ = true;
};

bool as_before(const ClockHistory& history, std::size_t i) {
  const ClockHistory::Edge &e = history[i], &o = history[i - history.length()];
  return e.tick == o.tick + history.period() && e.phase == o.phase && e.servo == o.servo;
}

// `known`: the edge that has told length and period. From one behind it on it is all a matter of the edges.
void expect_exact(const ClockHistory& history, std::size_t known) {
  bool repeats = history.length() != 0;
  ASSERT_EQ(history.repeats_from(history.size()), repeats && known < history.size());
  for (std::size_t i = history.size(); i-- > 0;) {
    repeats = repeats && i > known && i >= history.length() && as_before(history, i);
    ASSERT_EQ(history.repeats_from(i), repeats) << "from edge " << i << " of " << history.size();
  }
}

TEST(ClockHistory, RepeatsFromTheEdgeBehindTheLastThatDoesNotFit) {
  std::mt19937 random(random_seed(1));
  for (const unsigned servo : {0u, 1u, 2u, 3u}) {
    RegularClocks clocks(servo);
    ClockHistory history;
    std::size_t known = 0, repeating = 0;
    for (int n = 0; n < 300; ++n) {
      if (random() % 40 == 0) clocks.late(1 + random() % 3);
      const std::size_t length = history.length();
      const Tick period = history.period();
      history.push(clocks.next());
      if (history.length() != length || history.period() != period) known = history.size() - 1;
      expect_exact(history, known);
      if (HasFatalFailure()) return;
      repeating += history.repeats_from(history.size() - 1);
    }
    EXPECT_GT(repeating, 40u) << servo;
    history.clear();
    EXPECT_EQ(history.size(), 0u);
    EXPECT_EQ(history.length(), 0u);
    EXPECT_EQ(history.period(), 0);
    EXPECT_FALSE(history.repeats_from(0));
  }
}

// Of SERVO where there is one, be it each 16th PHASE at most, both edges of it and of PHASE beside each other; of PHASE
// without, from the 34th edge behind the last fall of SERVO on.
TEST(ClockHistory, LengthAndPeriodAreThoseOfServo) {
  for (unsigned servo = 1; servo <= 8; ++servo) {  // two falls of PHASE for both edges
    RegularClocks clocks(servo);
    ClockHistory history;
    for (unsigned n = 0; n < 12 * servo; ++n) history.push(clocks.next());
    EXPECT_EQ(history.length(), 4 * servo);
    EXPECT_EQ(history.period(), Tick{400} * servo);
  }
  RegularClocks clocks(0);
  ClockHistory history;
  for (int n = 0; n < 36; ++n) {
    history.push(clocks.next());
    EXPECT_EQ(history.length(), 0u) << "edge " << n;
  }
  for (int n = 36; n < 40; ++n) history.push(clocks.next());
  EXPECT_EQ(history.length(), 2u);
  EXPECT_EQ(history.period(), 200);
  ClockHistory both;  // the edges of SERVO by themselves
  Tick tick = 0;
  for (int n = 0; n < 3 * 34; ++n) {
    tick += 100;
    const int at = n % 34;
    both.push({tick, at == 0 || at == 17 ? at == 17 : (at - (at > 17)) % 2 == 0, at >= 17});
    EXPECT_TRUE(both.length() == 0 || both.length() == 34) << "edge " << n << ", " << both.length();
  }
  EXPECT_EQ(both.length(), 34u);
}

// Eight periods that repeat are worth to be caught up with before they end; and no list is longer than 32768 edges.
TEST(ClockHistory, EndsWithALongRegularStretchOrWhenItIsFull) {
  for (const unsigned servo : {1u, 2u}) {
    RegularClocks clocks(servo);
    ClockHistory history;
    std::size_t known = 0;
    for (std::size_t n = 0; n < 32768; ++n) {
      ASSERT_EQ(history.size(), n);
      const ClockHistory::Edge e = clocks.next();
      const std::size_t eight = 8 * history.length();
      const bool regular = eight != 0 && n > eight + history.length() && n - eight > known;
      ASSERT_EQ(history.should_end({e.tick + 1, e.phase, e.servo}), regular) << n;
      ASSERT_EQ(history.should_end({e.tick, !e.phase, e.servo}), regular) << n;
      ASSERT_EQ(history.should_end({e.tick, e.phase, !e.servo}), regular) << n;
      ASSERT_FALSE(history.should_end(e)) << n;
      const std::size_t length = history.length();
      history.push(e);
      if (history.length() != length) known = n;
    }
    EXPECT_TRUE(history.should_end(clocks.next()));
  }
}

}  // namespace
}  // namespace brick
