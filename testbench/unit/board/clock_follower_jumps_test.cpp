// What a follower of the clocks executes and what it leaves out (systemc/servo_ic/clock_follower.h), on a follower that
// writes down what it is told.
#include <gtest/gtest.h>

#include <vector>

#include "systemc/servo_ic/clock_follower.h"

namespace brick {
namespace {

class Diary final : public ClockFollower {
 public:
  bool same = true;  // what it says when it is asked whether its state repeats
  std::vector<ClockHistory::Edge> edges;
  Tick now = 0, jumped = 0;
  unsigned jumps = 0;

  void set_pins(bool phase, bool servo) override { edges.push_back({now, phase, servo}); }
  const ClockGen& clock_gen() const override { return clock_gen_; }
  Tick next_event() const override { return kNever; }
  void advance(Tick t) override {
    EXPECT_GE(t, now) << "backwards";
    now = t;
  }
  void reset(Tick t) override { now = t; }

 private:
  void mark() override {}
  bool repeats() const override { return same; }
  void jump(Tick by) override {
    now += by;
    jumped += by;
    ++jumps;
  }

  ClockGen clock_gen_{sc_core::sc_gen_unique_name("clock_gen")};
};

// PHASE turns each 100 ticks from tick 100 on; SERVO, where there is one, with each fall of it.
constexpr Tick kHalf = 100;
ClockHistory history_of(int edges, bool with_servo) {
  ClockHistory history;
  bool servo = true;
  for (int n = 1; n <= edges; ++n) {
    const bool phase = n % 2 == 0;
    if (with_servo && !phase) servo = !servo;
    history.push({n * kHalf, phase, servo});
  }
  return history;
}

// At most: until the period is known, three to see that the state repeats, to jump and to execute the last one again;
// without SERVO PHASE counts after as many edges as SERVO could have in its longest period.
TEST(ClockFollowerJumps, AThousandPeriodsAreAFewEdges) {
  for (const bool servo : {true, false}) {
    const int length = servo ? 4 : 2, longest = servo ? 0 : 34;
    const ClockHistory history = history_of(1000 * length, servo);
    for (const int missed : {0, 1, length - 1, length, length + 1}) {
      const int last = 1000 * length - missed;
      for (const Tick past : {0, 1, 63, 64, 99}) {
        SCOPED_TRACE(::testing::Message() << servo << ", up to edge " << last << " and " << past << " ticks past it");
        Diary ic;
        ic.catch_up(history, last * kHalf + past);
        EXPECT_EQ(ic.now, last * kHalf + past);
        EXPECT_EQ(ic.jumps, 1u);
        EXPECT_EQ(ic.jumped % (length * kHalf), 0);
        EXPECT_EQ(static_cast<Tick>(ic.edges.size()) + ic.jumped / kHalf, last) << "each is executed or left out";
        EXPECT_LE(ic.edges.size(), 8u * static_cast<unsigned>(length) + static_cast<unsigned>(longest));
        ASSERT_GE(ic.edges.size(), static_cast<unsigned>(length)) << "the last period is executed";
        for (int n = 0; n < length; ++n) {
          const ClockHistory::Edge& seen = ic.edges[ic.edges.size() - 1 - static_cast<std::size_t>(n)];
          const ClockHistory::Edge& is = history[static_cast<std::size_t>(last - 1 - n)];
          EXPECT_EQ(seen.tick, is.tick);
          EXPECT_EQ(seen.phase, is.phase);
          EXPECT_EQ(seen.servo, is.servo);
        }
      }
    }
  }
}

// PHASE is low for `low` ticks and high for the rest of 200, SERVO turns with its falls.
ClockHistory history_of_widths(std::size_t edges, Tick low) {
  ClockHistory history;
  Tick tick = 100;
  bool phase = true, servo = true;
  while (history.size() < edges) {
    phase = !phase;
    if (!phase) servo = !servo;
    history.push({tick, phase, servo});
    tick += phase ? 200 - low : low;
  }
  return history;
}

// The first edge of the period that is looked at has had 64 ticks of calm before it. From there on three periods must
// be to come: one passes to see that the state repeats, all but the last that are whole by then are left out.
TEST(ClockFollowerJumps, LeaveOutAllPeriodsButTheTwoThatAreNeeded) {
  constexpr std::size_t kLength = 4;
  constexpr Tick kPeriod = 400;
  for (const Tick low : {40, 63, 64, 100, 136, 137, 160}) {
    const ClockHistory whole = history_of_widths(100, low);
    std::size_t first = kLength;
    while (!whole.repeats_from(first) || whole[first].tick - whole[first - 1].tick < 64) ++first;
    for (std::size_t edges = first; edges < first + 7 * kLength; ++edges) {
      const ClockHistory history = history_of_widths(edges, low);
      const Tick last = history[edges - 1].tick;
      for (Tick end = last - kPeriod - 20; end <= last + 20; end += end > last - 3 && end < last + 3 ? 1 : 13) {
        SCOPED_TRACE(::testing::Message() << low << ", " << edges << " edges, up to tick " << end);
        Diary ic;
        ic.catch_up(history, end);
        const Tick seen = whole[first + kLength].tick - 1;  // it repeats
        Tick periods = edges > first + 3 * kLength && end > seen ? (end - seen) / kPeriod - 1 : 0;
        periods = std::max<Tick>(0, std::min<Tick>(periods, static_cast<Tick>((edges - first) / kLength) - 2));
        EXPECT_EQ(ic.jumped, periods * kPeriod);
        EXPECT_EQ(ic.now, end);
      }
    }
  }
}

// One whose state does not repeat, or that is asked each period, executes all edges, each with its levels.
TEST(ClockFollowerJumps, WhatDoesNotRepeatIsExecuted) {
  constexpr int kEdges = 400;
  const ClockHistory history = history_of(kEdges, true);
  for (const bool asked : {false, true}) {
    Diary ic;
    ic.same = asked;
    for (Tick t = 0; asked && t < kEdges * kHalf; t += 4 * kHalf) ic.catch_up(history, t);
    ic.catch_up(history, kEdges * kHalf);
    EXPECT_EQ(ic.jumps, 0u);
    ASSERT_EQ(ic.edges.size(), history.size());
    for (std::size_t n = 0; n < history.size(); ++n) {
      EXPECT_EQ(ic.edges[n].tick, history[n].tick);
      EXPECT_EQ(ic.edges[n].phase, history[n].phase);
      EXPECT_EQ(ic.edges[n].servo, history[n].servo);
    }
  }
}

}  // namespace
}  // namespace brick
