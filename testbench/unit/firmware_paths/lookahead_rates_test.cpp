// What is handed over next and how long it takes (firmware/motion/lookahead_plan.h), rates of a sweep, and where the
// words of a lookahead buffer lie, by states that the test makes (motion:7.4, motion:7.5).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#define error_t firmware_error_t  // the C library has a type of this name
extern "C" {
#include "firmware/buffers/regions.h"
#include "firmware/motion/lookahead_limits.h"
#include "firmware/motion/lookahead_plan.h"
#include "firmware/motion/lookahead_state.h"
}
#include "testbench/unit/firmware_program/platform.h"

namespace {

constexpr double kFull = RATE_FULL, kTicksOfMs = 8388608.0;

// One motor, knots 0 to 8 of segments of 40 ms; move n + 100 at control point n.
class LookaheadRates : public ::testing::Test {
 protected:
  static constexpr std::uint32_t kEnd = 8, kPoints = kEnd + 3, kStride = 6;
  LookaheadRates() {
    l = {};
    l.buffer = {words_.data(), kStride, kPoints};
    l.added = kPoints;
    l.length = 9;
    l.period = 40;
    l.motor_count = 1;
    for (std::uint32_t i = 0; i < kPoints; ++i) {
      at(i).cap = RATE_FULL;
      at(i).number = 100 + i;
      at(i).line.first.offset = static_cast<std::uint16_t>(200 + i);
    }
  }
  ~LookaheadRates() override { l = {}; }
  lookahead_record& at(std::uint32_t knot) { return *lookahead_at(&l.buffer, knot); }
  void bend(std::int32_t by) {
    for (std::uint32_t i = 0; i < kPoints; ++i) lookahead_of(&at(i))->bend = by;
  }
  void stand_at(std::uint32_t front, std::uint32_t part, std::int32_t rate, bool backward = false) {
    l.front = front;
    l.part = part;
    l.rate = rate;
    l.backward = backward;
    l.state = LOOK_GOES;
    l.next = LOOKAHEAD_NONE;
    l.begun = true;
    l.single = l.closed = false;
    l.rooted = -1;
  }
  lookahead_piece released() {
    lookahead_piece piece = {};
    EXPECT_TRUE(lookahead_release(0, false, &piece));
    EXPECT_EQ(piece.number, 100 + piece.segment + 2);
    EXPECT_EQ(piece.line.first.offset, 200 + piece.segment + 2);
    return piece;
  }
  // The rate changes evenly along the way: T parts / 16 over the mean of both roots, warp their difference over their
  // sum.
  static void expect_time(const lookahead_piece& piece, double parts, double from, double to, double tolerance) {
    const double a = std::sqrt(from / kFull), b = std::sqrt(to / kFull), ms = 40 * parts / 16;
    EXPECT_NEAR(static_cast<double>(piece.time) / kTicksOfMs, 2 * ms / (a + b), 2 * ms / (a + b) * tolerance);
    EXPECT_NEAR(piece.warp / kFull, (a - b) / (a + b), tolerance);
  }
  look& l = looks[0];

 private:
  std::vector<std::uint64_t> words_ = std::vector<std::uint64_t>(kStride * kPoints);
};

// Back to the rate of the program: from wherever a stop has left it, in one segment where nothing limits that.
TEST_F(LookaheadRates, AfterAStopAProgramGoesOnAtItsRate) {
  for (const std::uint32_t part : {0u, 4u, 12u})
    for (const std::int32_t rate : {64, 1 << 20, 1 << 28, RATE_FULL / 2, RATE_FULL - 1, int{RATE_FULL}}) {
      SCOPED_TRACE(rate);
      stand_at(3, part, rate);
      const lookahead_piece first = released(), second = released();
      EXPECT_EQ(first.segment, 3u);
      EXPECT_EQ(first.first, part);
      EXPECT_EQ(first.last, 16u);
      EXPECT_EQ(first.rate, rate);
      expect_time(first, 16 - part, rate, RATE_FULL, 1e-6);
      EXPECT_EQ(second.segment, 4u);
      EXPECT_EQ(second.first, 0u);
      EXPECT_EQ(second.rate, RATE_FULL);
      EXPECT_EQ(second.time, std::int64_t{40} << 23);
      EXPECT_EQ(second.warp, 0);
      EXPECT_EQ(l.front, 5u);
      EXPECT_EQ(l.part, 0u);
    }
}

// Beyond the limits anyway, a bend of 32 times what they allow: it rises by what the change alone may ask, an eighth a
// segment (|x' w' / 2| with x' of a quarter of it), to 1 and no further.
TEST_F(LookaheadRates, BeyondTheLimitsItRisesByWhatTheChangeMayAsk) {
  bend(32 << BEND_BITS);
  for (const double rate : {0.5, 0.7, 0.86}) {
    stand_at(2, 0, static_cast<std::int32_t>(rate * kFull));
    released();
    EXPECT_NEAR(l.rate / kFull, rate + 0.125, 0.001);
    EXPECT_LT(l.rate, RATE_FULL);
  }
  for (const double rate : {0.88, 0.95, 1.0}) {
    stand_at(2, 0, static_cast<std::int32_t>(rate * kFull));
    released();
    EXPECT_EQ(l.rate, RATE_FULL) << rate;
    const lookahead_piece next = released();
    EXPECT_EQ(next.rate, RATE_FULL);
    EXPECT_EQ(next.time, std::int64_t{40} << 23);
    EXPECT_EQ(next.warp, 0);
  }
}

// A stop: within the segment under way, at its next quarters, or at its end where less is left.
TEST_F(LookaheadRates, AStopIsAtAQuarterOfItsSegment) {
  const struct {
    std::uint32_t part, last;
    bool backward;
  } cases[] = {{0, 4, false}, {4, 8, false}, {9, 13, false}, {12, 16, false}, {14, 16, false},
               {0, 12, true}, {12, 8, true}, {9, 5, true},   {4, 0, true},    {3, 0, true}};
  for (const auto& c : cases) {
    SCOPED_TRACE(::testing::Message() << c.part << " to " << c.last);
    stand_at(5, c.part, RATE_FULL, c.backward);
    l.state = LOOK_STOPS;
    const lookahead_piece piece = released();
    const std::uint32_t segment = c.backward && c.part == 0 ? 4 : 5, first = c.backward && c.part == 0 ? 16 : c.part;
    EXPECT_EQ(piece.segment, segment);
    EXPECT_EQ(piece.first, first);
    EXPECT_EQ(piece.last, c.last);
    expect_time(piece, std::abs(static_cast<int>(c.last) - static_cast<int>(first)), RATE_FULL, 0, 1e-6);
    EXPECT_EQ(l.state, LOOK_STANDS);
    EXPECT_EQ(l.rate, 0);
    EXPECT_EQ(l.front, c.last == 16 ? 6u : segment);
    EXPECT_EQ(l.part, c.last % 16);
    lookahead_piece none = {};
    EXPECT_FALSE(lookahead_release(0, true, &none));
  }
}

// Where it rests, or at the end of what there is, it stands at once.
TEST_F(LookaheadRates, AStopWithoutAWayIsNone) {
  const struct {
    std::uint32_t front;
    std::int32_t rate;
    bool backward, stands;
  } cases[] = {{5, 63, false, true},           {5, 64, false, false},
               {kEnd, RATE_FULL, false, true}, {kEnd - 1, RATE_FULL, false, false},
               {0, RATE_FULL, true, true},     {1, RATE_FULL, true, false}};
  for (const auto& c : cases) {
    SCOPED_TRACE(::testing::Message() << c.front << " at " << c.rate);
    stand_at(c.front, 0, c.rate, c.backward);
    l.state = LOOK_STOPS;
    lookahead_piece piece = {};
    EXPECT_EQ(lookahead_release(0, false, &piece), !c.stands);
    EXPECT_EQ(l.state, LOOK_STANDS);
    EXPECT_EQ(l.rate, 0);
  }
}

// To the next knot and to rest again in two halves, or in those of what is left of the segment. No piece lasts longer
// than a move may, 2^23 - 1 ms: from a w of 2^-30 half a segment takes 2^15 times its period.
TEST_F(LookaheadRates, ASegmentAloneIsTwoHalves) {
  for (const bool backward : {false, true})
    for (const std::uint32_t part : {0u, 6u}) {
      stand_at(4, part, 0, backward);
      l.single = true;
      const lookahead_piece up = released(), down = released();
      const std::uint32_t segment = backward && part == 0 ? 3 : 4, first = backward && part == 0 ? 16 : part,
                          last = backward ? 0 : 16, middle = (first + last) / 2;
      EXPECT_EQ(up.segment, segment);
      EXPECT_EQ(up.first, first);
      EXPECT_EQ(up.last, middle);
      EXPECT_EQ(up.rate, 0);
      EXPECT_EQ(down.first, middle);
      EXPECT_EQ(down.last, last);
      EXPECT_EQ(down.rate, RATE_FULL);
      const double parts = std::abs(static_cast<int>(last) - static_cast<int>(first)) / 2.0;
      expect_time(up, parts, 0, RATE_FULL, 1e-6);
      expect_time(down, parts, RATE_FULL, 0, 1e-6);
      EXPECT_EQ(l.state, LOOK_STANDS);
      EXPECT_FALSE(l.single);
    }
  for (const std::uint32_t period : {250u, 255u, 257u, 260u, 500u}) {
    stand_at(4, 8, 1);
    l.single = true;
    l.period = period;
    const double ms = static_cast<double>(released().time) / kTicksOfMs;
    if (period > 256)
      EXPECT_EQ(ms, 8388607.0) << period;
    else
      EXPECT_NEAR(ms, period * 32768.0, period * 2.0);
  }
}

// The w between both halves is the lesser of what they allow, from either side: that of a segment that is run through
// the other way round is the same. Where its cap leaves nothing it creeps.
TEST_F(LookaheadRates, ASegmentAloneKeepsToTheLimitsOfBothHalves) {
  constexpr std::int32_t kTurns = 40 << BEND_BITS;
  const auto middle = [this](std::int32_t pace, std::int32_t from, std::int32_t to) {
    lookahead_motors(&l.buffer, 4)[0] = {0, pace, from};
    lookahead_motors(&l.buffer, 5)[0] = {0, pace + (from + to) / 2, to};
    stand_at(4, 0, 0);
    l.single = true;
    released();
    return l.rate / kFull;
  };
  const double grows = middle(0, 0, kTurns), mirrored = middle(-kTurns / 2, kTurns, 0);
  EXPECT_NEAR(grows, 1.0 / 25, 0.0002) << "x'' = 20 and x' = 5 with w' = 2 w at the end of the first half: 25 w = 1";
  EXPECT_NEAR(mirrored, 1.0 / 25, 0.0002);
  at(4).cap = 0;
  EXPECT_EQ(middle(0, 0, 0), 1 / kFull);
}

// Without accelerations that limit it, w at a knot is the lesser of the caps at both sides; 0 at a stop on the way
// forwards. At the ends of a sequence that is closed one side counts.
TEST_F(LookaheadRates, ASweepKeepsToTheCapsOfBothSides) {
  const std::int32_t caps[kEnd] = {900, 700, 800, 600, 1000, 950, 500, 720};
  for (const bool closed : {false, true})
    for (const bool backward : {false, true}) {
      SCOPED_TRACE(::testing::Message() << closed << backward);
      stand_at(backward ? kEnd : 0, 0, 0, backward);
      l.closed = closed;
      l.begun = backward;
      l.limits = true;
      l.swept = l.good = 0;
      l.sweeping = l.swept_back = false;
      for (std::uint32_t i = 0; i < kPoints; ++i) {
        at(i).cap = (i < kEnd ? caps[i] : 50) << 15;  // behind the end and before the oldest there is none yet
        at(i).stops = i == 4;
        at(i).rate = -1;
      }
      for (int i = 0; i < 100 && lookahead_sweep(0, true); ++i) {}
      EXPECT_FALSE(lookahead_is_sweeping(0));
      EXPECT_EQ(l.rates_back, backward);
      EXPECT_EQ(l.swept_back, backward);
      if (!backward) {
        EXPECT_EQ(l.swept, kEnd);
        EXPECT_EQ(l.good, closed ? kEnd : 1u) << "a quarter of the window does not see its end";
      }
      for (std::uint32_t knot = 0; knot <= kEnd; ++knot) {
        std::int32_t expected = std::min(knot > 0 ? caps[knot - 1] : 1000, knot < kEnd ? caps[knot] : 1000) << 15;
        if (!backward && knot == 4) expected = 0;
        if (!backward && knot == kEnd && !closed) expected = 0;
        EXPECT_EQ(at(knot).rate, expected) << knot;
      }
      for (std::uint32_t i = 0; i < kPoints; ++i) at(i).stops = false;
    }
}

// On a limited path the front goes as far as knots are good; in a hurry as far as they have been swept.
TEST_F(LookaheadRates, TheFrontGoesAsFarAsTheSweepIsGood) {
  for (const bool hurry : {false, true})
    for (const std::uint32_t good : {0u, 3u, 4u, 5u})
      for (const std::uint32_t swept : {3u, 4u, 5u})
        for (const bool sweeping : {false, true})
          for (const std::int32_t rate : {0, 1 << 20}) {
            stand_at(3, 0, 1 << 20);
            l.limits = true;
            l.good = good;
            l.swept = swept;
            l.sweeping = sweeping;
            at(4).rate = rate;
            lookahead_piece piece = {};
            const bool goes = good >= 4 || (hurry && swept >= 4 && (!sweeping || rate != 0));
            EXPECT_EQ(lookahead_release(0, hurry, &piece), goes) << hurry << good << swept << sweeping << rate;
            EXPECT_EQ(l.front, goes ? 4u : 3u);
            EXPECT_EQ(l.rate, goes ? rate : 1 << 20);
          }
  l.limits = false;
}

// 2 x + 4 words a record of x motors, then two a slot, at the end of the buffer, whatever lies below and above it.
TEST(LookaheadBuffer, SlotsAreBehindTheRecords) {
  platform::power_up();
  ASSERT_EQ(platform::host("&9#1->X #2->Y #3->Z &2DEF LOOK 30,7"), "");
  lookahead_buffer none = {};
  void* slots = nullptr;
  EXPECT_EQ(lookahead_slots(0, &slots), 0u);
  EXPECT_EQ(slots, nullptr);
  lookahead_buffer_open(0, 2, &none);
  EXPECT_EQ(none.records, 0u);
  EXPECT_FALSE(lookahead_buffer_is_defined(0));
  EXPECT_TRUE(lookahead_buffer_is_defined(1));
  EXPECT_TRUE(lookahead_buffer_is_anywhere());
  ASSERT_EQ(platform::host("&2DEL LOOK"), "");
  EXPECT_FALSE(lookahead_buffer_is_anywhere());
  ASSERT_EQ(platform::host("&9DEF CCBUF 20 DEF LOOK 30,7 &2DEF LOOK 20,5 &16DEF ROT 100 &9DEF ROT 200 &2DEF ROT 300"),
            "");
  lookahead_buffer of9 = {}, of2 = {};
  lookahead_buffer_open(8, 3, &of9);
  lookahead_buffer_open(1, 0, &of2);
  EXPECT_EQ(of9.stride, 10u);
  EXPECT_EQ(of9.records, 30u);
  void *slots9 = nullptr, *slots2 = nullptr;
  EXPECT_EQ(lookahead_slots(8, &slots9), 7u);
  EXPECT_EQ(lookahead_slots(1, &slots2), 5u);
  const std::uint32_t words9 = region_words(REGION_LOOKAHEAD, 8), words2 = region_words(REGION_LOOKAHEAD, 1);
  EXPECT_EQ(static_cast<std::uint64_t*>(slots9), of9.words + words9 - 14);
  EXPECT_EQ(static_cast<std::uint64_t*>(slots2), of2.words + words2 - 10);
  EXPECT_EQ(of9.words, of2.words + words2) << "that of a higher system is above";
}

}  // namespace
