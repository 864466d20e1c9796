// When moves of axes without motors begin and end (firmware/motion/place.h), by moves that the test calculates: a blend
// in time, shortened or too late, and one that is taken back (motion:5.2, firmware:4.10).
#include <algorithm>

#include "testbench/unit/firmware_program/platform.h"

extern "C" {
#include "firmware/motion/place.h"
#include "firmware/motion/system_path.h"
}

namespace {

constexpr std::int64_t kStep = 1000;  // trajectory time of an interrupt

class VirtualMoves : public FirmwareTest {
 protected:
  void SetUp() override {
    FirmwareTest::SetUp();
    s.increment = s.increment_target = s.increment_command = s.increment_before = kStep;
    s.increment_full = kStep;
    s.increment_slew = s.increment_usual = INT32_MAX;
    s.first = true;
  }
  move& next() { return s.moves[s.executing ^ 1u]; }
  // Calculated and placed, as the real-time task does it.
  void calculate(move_kind kind, std::int64_t time, std::int64_t acceleration, bool joins) {
    next() = {};
    next().kind = kind;
    next().time = time;
    next().acceleration = acceleration;
    next().joins = joins;
    s.next_valid = true;
    ASSERT_TRUE(move_place(0));
    ASSERT_TRUE(s.placed);
    ASSERT_FALSE(move_place(0)) << "it is placed";
  }
  // Interrupts until another move begins or the last one ends; the time that the one before has had by then.
  std::int64_t until_the_next() {
    const std::uint32_t started = s.started;
    std::int64_t passed = s.elapsed;
    for (int i = 0; i < 5000 && s.active && s.started == started; ++i) {
      system_path_servo();
      passed += kStep;
    }
    return s.started != started ? passed - s.elapsed : passed;
  }
  void begin() {
    system_path_servo();
    ASSERT_TRUE(s.active);
    ASSERT_EQ(s.elapsed, 0);
  }
  void go(std::int64_t elapsed) {
    while (s.elapsed < elapsed) system_path_servo();
    ASSERT_EQ(s.elapsed, elapsed);
  }
  // A move from rest of 100000 with 20000 of acceleration: corners at 10000 and 110000, rest at 120000.
  void first(std::int64_t elapsed) {
    ASSERT_NO_FATAL_FAILURE(calculate(MOVE_LINEAR, 100000, 20000, true));
    EXPECT_FALSE(next().blended);
    ASSERT_NO_FATAL_FAILURE(begin());
    ASSERT_NO_FATAL_FAILURE(go(elapsed));
  }
  coordinate_system& s = coordinate_systems[0];
};

// Tm + Ta from rest to rest.
TEST_F(VirtualMoves, AloneItTakesItsTimeAndItsAcceleration) {
  for (const std::int64_t acceleration : {std::int64_t{0}, 2 * kStep, 20 * kStep, 80 * kStep}) {
    ASSERT_NO_FATAL_FAILURE(calculate(MOVE_LINEAR, 80 * kStep, acceleration, true));
    ASSERT_NO_FATAL_FAILURE(begin());
    EXPECT_EQ(until_the_next(), 80 * kStep + acceleration);
    EXPECT_FALSE(s.active);
  }
  for (const move_kind kind : {MOVE_DWELL, MOVE_OWN}) {
    ASSERT_NO_FATAL_FAILURE(calculate(kind, 70 * kStep, 0, false));
    ASSERT_NO_FATAL_FAILURE(begin());
    EXPECT_EQ(until_the_next(), 70 * kStep);
  }
}

// Half its acceleration before the corner, no earlier than the first blend has ended and than it is there; with the
// stop begun, from rest behind that.
TEST_F(VirtualMoves, ABlendBeginsHalfAnAccelerationBeforeTheCorner) {
  for (const std::int64_t acceleration : {10000, 20000, 60000, 180000, 400000})
    for (const std::int64_t elapsed : {1000, 15000, 50000, 89000, 90000, 99000, 100000, 105000, 119000})
      for (const bool joins : {true, false}) {
        SCOPED_TRACE(::testing::Message() << acceleration << " at " << elapsed << ", " << joins);
        platform::power_up();
        SetUp();
        ASSERT_NO_FATAL_FAILURE(first(elapsed));
        ASSERT_NO_FATAL_FAILURE(calculate(MOVE_LINEAR, 400000, acceleration, joins));
        const bool blends = joins && elapsed < 100000;
        const std::int64_t half = std::min({acceleration / 2, std::int64_t{90000}, 110000 - elapsed});
        EXPECT_EQ(next().blended, blends);
        if (blends) { EXPECT_EQ(next().blend_in, 2 * half); }
        EXPECT_EQ(until_the_next(), blends ? 110000 - half : 120000);
        EXPECT_EQ(s.started, 2u);
        ASSERT_TRUE(s.active);
        EXPECT_EQ(until_the_next(), (blends ? half : acceleration / 2) + 400000 + acceleration / 2);
        EXPECT_FALSE(s.active);
      }
}

// `/`: the move ends at its corner all the same; what is too late for that stops as fast as its time allows.
TEST_F(VirtualMoves, ABlendThatIsTakenBackIsAStop) {
  for (const std::int64_t elapsed : {1000, 50000, 79000, 95000, 100000, 104000})
    for (const bool joins : {true, false}) {
      SCOPED_TRACE(::testing::Message() << elapsed << ", " << joins);
      platform::power_up();
      SetUp();
      ASSERT_NO_FATAL_FAILURE(first(30000 < elapsed ? 30000 : 1000));
      ASSERT_NO_FATAL_FAILURE(calculate(MOVE_LINEAR, 400000, 10000, joins));  // it would blend at 105000
      ASSERT_NO_FATAL_FAILURE(go(elapsed));
      const std::uint32_t added = s.ring.added;
      move_take_back(0);
      EXPECT_FALSE(s.placed);
      EXPECT_TRUE(next().waited);
      move_take_back(0);  // nothing is there
      const std::int64_t stop = !joins ? 20000 : elapsed <= 100000 ? 20000 : 2 * (110000 - elapsed);
      EXPECT_EQ(until_the_next(), 110000 + stop / 2);
      EXPECT_EQ(s.started, 1u);
      EXPECT_FALSE(s.active);
      EXPECT_TRUE(piece_ring_is_empty(&s.ring));
      if (!joins) { EXPECT_EQ(s.ring.added, added - 3) << "its three pieces"; }
    }
}

// Nothing is placed before it is calculated, behind `/`, or while moves are dropped.
TEST_F(VirtualMoves, NothingIsPlacedThatMayNotBegin) {
  next() = {};
  next().kind = MOVE_LINEAR;
  next().time = 5000;
  EXPECT_FALSE(move_place(0)) << "none is calculated";
  s.next_valid = s.end_block = true;
  EXPECT_FALSE(move_place(0));
  s.end_block = false;
  s.settling = true;
  move_place(0);
  EXPECT_FALSE(s.placed);
  s.settling = false;
  EXPECT_TRUE(move_place(0));
  EXPECT_FALSE(s.first);
  EXPECT_NE(cs_busy & 1u, 0u);
}

}  // namespace
