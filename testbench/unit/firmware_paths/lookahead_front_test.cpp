// What the front of a sequence says of itself (firmware/motion/lookahead_plan.h), by states that the test makes: each
// answer as its header has it.
#include <gtest/gtest.h>

#include <string>

extern "C" {
#include "firmware/motion/lookahead_limits.h"
#include "firmware/motion/lookahead_plan.h"
#include "firmware/motion/lookahead_state.h"
}

namespace {

// Eleven points of a buffer of a hundred: knots 0 to 8.
class LookaheadFront : public ::testing::Test {
 protected:
  static constexpr std::uint32_t kEnd = 8;
  LookaheadFront() {
    l = {};
    l.added = kEnd + 3;
    l.buffer.records = 100;
  }
  ~LookaheadFront() override { l = {}; }
  static lookahead_piece piece(std::uint32_t segment, std::uint32_t first, std::uint32_t last,
                               std::int32_t rate = RATE_FULL) {
    lookahead_piece p = {};
    p.segment = segment;
    p.first = first;
    p.last = last;
    p.rate = rate;
    return p;
  }
  look& l = looks[0];
};

// w below 64 is rest; so are the first knot, if it is still stored, and the last of a sequence that is closed.
TEST_F(LookaheadFront, APieceBeginsAtRest) {
  const struct {
    std::uint32_t segment, first, last;
    bool open, closed, wrapped;
  } cases[] = {{0, 0, 16, true, true, false},          {0, 4, 16, false, false, false},
               {1, 0, 16, false, false, false},        {0, 16, 0, false, false, false},
               {kEnd - 1, 16, 0, false, true, true},   {kEnd - 1, 0, 16, false, false, false},
               {kEnd - 2, 16, 0, false, false, false}, {kEnd - 1, 12, 0, false, false, false},
               {kEnd, 0, 16, false, true, true}};
  for (const auto& c : cases) {
    SCOPED_TRACE(std::to_string(c.segment) + " from " + std::to_string(c.first));
    const lookahead_piece p = piece(c.segment, c.first, c.last);
    l.closed = false;
    l.buffer.records = 100;
    EXPECT_EQ(lookahead_begins_at_rest(0, &p), c.open);
    l.closed = true;
    EXPECT_EQ(lookahead_begins_at_rest(0, &p), c.closed);
    l.buffer.records = 10;  // the first is written over
    EXPECT_EQ(lookahead_begins_at_rest(0, &p), c.wrapped);
    EXPECT_EQ(lookahead_is_stored(0, &p), c.segment >= 1);
    for (const std::int32_t rate : {0, 63, 64}) {
      const lookahead_piece slow = piece(c.segment, c.first, c.last, rate);
      EXPECT_EQ(lookahead_begins_at_rest(0, &slow), rate < 64 || c.wrapped) << rate;
    }
  }
}

TEST_F(LookaheadFront, WhatIsTakenBackIsTheFrontAgain) {
  const struct {
    std::uint32_t segment, first, last, front, part;
    bool backward;
  } cases[] = {{5, 0, 16, 5, 0, false},
               {5, 4, 16, 5, 4, false},
               {5, 16, 0, 6, 0, true},
               {5, 12, 8, 5, 12, true},
               {5, 12, 16, 5, 12, false}};
  for (const auto& c : cases)
    for (const look_state state : {LOOK_GOES, LOOK_STOPS, LOOK_STANDS}) {
      SCOPED_TRACE(std::to_string(c.first) + " to " + std::to_string(c.last));
      l.front = 7;
      l.part = 3;
      l.rate = 1;
      l.backward = !c.backward;
      l.state = state;
      const lookahead_piece p = piece(c.segment, c.first, c.last, 777);
      lookahead_take_back(0, &p);
      EXPECT_EQ(l.front, c.front);
      EXPECT_EQ(l.part, c.part);
      EXPECT_EQ(l.rate, 777);
      EXPECT_EQ(l.backward, c.backward);
      EXPECT_EQ(lookahead_is_backward(0), c.backward);
      EXPECT_EQ(l.state, state == LOOK_STANDS ? LOOK_STOPS : state);
    }
}

TEST_F(LookaheadFront, RestsAtASlowRateAndAtItsEnds) {
  for (const bool closed : {false, true})
    for (const std::uint32_t front : {0u, 1u, kEnd - 1, kEnd})
      for (const std::uint32_t part : {0u, 1u, 8u})
        for (const std::int32_t rate : {0, 63, 64, int{RATE_FULL}}) {
          l.closed = closed;
          l.front = front;
          l.part = part;
          l.rate = rate;
          l.state = LOOK_GOES;
          l.backward = false;
          const bool free = part == 0 && (front == 0 || (closed && front == kEnd));
          EXPECT_EQ(lookahead_rests(0), rate < 64 || free) << front << " " << part << " " << rate;
          EXPECT_EQ(lookahead_is_over(0), closed && front == kEnd && part == 0) << front << " " << part;
          EXPECT_FALSE(lookahead_is_at_oldest(0));
          l.backward = true;
          EXPECT_FALSE(lookahead_is_over(0));
          EXPECT_EQ(lookahead_is_at_oldest(0), front == 0 && part == 0);
          l.buffer.records = kEnd + 2;
          EXPECT_TRUE(lookahead_is_wrapped(0));
          EXPECT_EQ(lookahead_is_at_oldest(0), front == 1 && part == 0);
          l.buffer.records = kEnd + 3;
          EXPECT_FALSE(lookahead_is_wrapped(0));
          l.backward = false;
          l.state = LOOK_STOPS;
          EXPECT_FALSE(lookahead_is_over(0));
        }
}

TEST_F(LookaheadFront, StandsUntilItHasAnOrder) {
  for (const look_state state : {LOOK_GOES, LOOK_STOPS, LOOK_STANDS})
    for (const lookahead_order next : {LOOKAHEAD_NONE, LOOKAHEAD_FORWARD, LOOKAHEAD_ONE_BACKWARD}) {
      l.state = state;
      l.next = next;
      EXPECT_EQ(lookahead_stands(0), state == LOOK_STANDS && next == LOOKAHEAD_NONE);
    }
  l.state = LOOK_STANDS;
  for (const lookahead_order order :
       {LOOKAHEAD_STOP, LOOKAHEAD_FORWARD, LOOKAHEAD_BACKWARD, LOOKAHEAD_ONE_FORWARD, LOOKAHEAD_ONE_BACKWARD}) {
    lookahead_do(0, order);
    EXPECT_EQ(l.next, order == LOOKAHEAD_STOP ? LOOKAHEAD_NONE : order);
    EXPECT_EQ(l.state, LOOK_STANDS);
  }
}

// motion:7.5: it goes on in its direction as long as what the rates say of the way there counts, else it stops first.
TEST_F(LookaheadFront, AnOrderInItsDirectionGoesOn) {
  for (const bool backward : {false, true})
    for (const bool rates_back : {false, true})
      for (const bool single : {false, true})
        for (const std::uint32_t valid : {3u, 4u, 5u, 6u})
          for (const lookahead_order order :
               {LOOKAHEAD_STOP, LOOKAHEAD_FORWARD, LOOKAHEAD_BACKWARD, LOOKAHEAD_ONE_FORWARD, LOOKAHEAD_ONE_BACKWARD}) {
            l.state = LOOK_STOPS;
            l.front = 5;  // the next knot is 6 or 4
            l.part = 0;
            l.backward = backward;
            l.rates_back = rates_back;
            l.single = single;
            l.valid = valid;
            lookahead_do(0, order);
            const bool counts = rates_back == backward && (backward ? 4 <= valid : 6 >= valid);
            const bool goes = order == (backward ? LOOKAHEAD_BACKWARD : LOOKAHEAD_FORWARD) && !single && counts;
            EXPECT_EQ(l.state, goes ? LOOK_GOES : LOOK_STOPS) << backward << rates_back << single << valid << order;
            EXPECT_EQ(l.next, goes || order == LOOKAHEAD_STOP ? LOOKAHEAD_NONE : order);
          }
}

// Isx21 shows 2 while it moves, 3 backwards, and 8 more behind an order for a segment.
TEST_F(LookaheadFront, ItsStateForIsx21) {
  const std::uint32_t expected[2][2][2] = {{{0, 10}, {2, 10}}, {{0, 11}, {3, 11}}};
  for (const bool backward : {false, true})
    for (const bool moves : {false, true})
      for (const bool single : {false, true}) {
        l.backward = backward;
        l.was_single = single;
        EXPECT_EQ(lookahead_state(0, moves), expected[backward][moves][single]);
      }
}

}  // namespace
