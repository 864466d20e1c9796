// Interrupts anywhere in the firmware while a move ends, is stopped, or has another one placed behind it: no motor
// leaps (motion:5.4/3, motion:7.1/8).
#include "testbench/unit/firmware_platform/fake_interrupts.h"

#include "testbench/unit/firmware_program/moving_motors.h"

extern "C" {
#include "firmware/motion/place.h"
}

namespace {

using namespace moving_motors;

// Counts that motor 1 has gone in one servo interrupt at most, and by how many more or less than in the one before.
double last_place, last_step, longest_step, longest_change;

void look() {
  const double now = static_cast<double>(motors[0].trajectory) / kUnit;
  longest_step = std::max(longest_step, std::abs(now - last_place));
  longest_change = std::max(longest_change, std::abs(now - last_place - last_step));
  last_step = now - last_place;
  last_place = now;
}

bool is_due;  // a servo interrupt has begun whose step has not been looked at

void look_at_step(fake_task task) {
  if (task != FAKE_SERVO) return;
  if (is_due) look();
  is_due = true;
}

class InterruptsOfMoves : public MovingMotors {
 protected:
  void SetUp() override {
    MovingMotors::SetUp();
    fit({"1000X", "1000Y"});
    ASSERT_EQ(host("I115=1 I119=1 I120=20 I121=0 I122=20 I192=1 I215=1"), "");
    longest_step = longest_change = last_step = last_place = 0;
  }
  void TearDown() override {
    fake_interrupts_on_take(nullptr);
    fake_interrupts_end();
  }
  static void begin() {
    ASSERT_EQ(host("&1B1R"), "");
    for (int i = 0; i < 200 && !cs().active; ++i) platform::servo_ticks(1);
    last_place = at(1);
  }
  static void ticks(unsigned count) {
    for (; count > 0; --count) {
      platform::servo_ticks(1);
      look();
    }
  }
  // `action`, and interrupts in it.
  template <typename Action>
  static void interrupted(std::uint32_t seed, std::uint32_t gap, Action action) {
    is_due = false;
    fake_interrupts_begin(seed, gap);
    fake_interrupts_on_take(look_at_step);
    action();
    fake_interrupts_on_take(nullptr);
    fake_interrupts_end();
    if (is_due) look();
  }
};

// The next move is calculated and placed in the last interrupts of a PVT move that ends at 5 counts a ms: in time or
// late.
TEST_F(InterruptsOfMoves, BehindPvtInMotionANextMoveIsInTimeOrLate) {
  unsigned in_time = 0, late = 0;
  for (const char* isx13 : {"I5113=0", "I5113=5"})
    for (const char* next : {"LINEAR TM100 X3", "RAPID X3", "SPLINE1 TM100 X3"}) {
      ASSERT_EQ(host(isx13), "");
      store({"TA20 TS0 PVT150 X1:5", next});
      for (std::uint32_t seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE(std::string(next) + " " + isx13 + ", seed " + std::to_string(seed));
        ASSERT_EQ(host("#1HMZ"), "");
        begin();
        ASSERT_FALSE(cs().next_valid);
        for (unsigned i = ticks_of(150) - 1 - seed % 4; i > 0; --i) {
          fake_task_run_servo();
          look();
        }
        interrupted(seed, 100 + seed % 5 * 300, [] { platform::real_time(); });
        ticks(ticks_of(700));
        ASSERT_LT(longest_step, 21 * kTickMs);
        ASSERT_FALSE(run_is_running(0));
        const bool is_late = cs().error == RUN_TIME_LATE;
        (is_late ? late : in_time)++;
        if (!is_late) { ASSERT_EQ(motors[0].trajectory, 3000 * 3072); }
      }
    }
  EXPECT_GT(in_time, 20u);
  EXPECT_GT(late, 20u);
}

// The servo interrupt leaves a PVT move in the middle of the look whether it has: that ends at its place or runs on.
TEST_F(InterruptsOfMoves, APvtMoveEndsAtItsPlaceOrRunsOn) {
  constexpr std::uint32_t kSeeds = 300;
  unsigned ends = 0, runs_on = 0;
  store({"TA20 TS0 PVT10 X0.05:5", "DWELL1"});
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    ASSERT_EQ(host("#1HMZ"), "");
    begin();
    for (unsigned i = ticks_of(10) - 1; i > 0; --i) fake_task_run_servo();
    unsigned pauses = 0;
    platform::real_time_in_slices([&] {
      if (++pauses != 1) return;
      cs().moves[cs().executing ^ 1u].kind = MOVE_DWELL;
      cs().next_valid = true;  // in the real-time task, where it is about to be calculated
      bool in_time = false;
      interrupted(seed, 6, [&] { in_time = move_ends(0); });
      cs().next_valid = false;
      (in_time ? ends : runs_on)++;
      for (unsigned i = 0; i < 20; ++i) fake_task_run_servo();
      ASSERT_EQ(motors[0].trajectory == 50 * 3072, in_time) << at(1);
    });
    ASSERT_GT(pauses, 0u);
    ASSERT_EQ(host("A"), "");
    ticks(ticks_of(50));
  }
  EXPECT_GT(ends, 100u);
  EXPECT_GT(runs_on, 5u);
}

// A stop comes while segments are made and what is behind them is calculated: motors stand at the end of a line, and
// come to the end of the program.
TEST_F(InterruptsOfMoves, AStopAmongSegmentsLeavesNoGap) {
  ASSERT_EQ(host("I5113=5"), "");
  unsigned corners[4] = {};
  for (const char* order : {"Q", "/", "S"})
    for (const char* behind : {"SPLINE1 TM100 X4", "RAPID X4", "DWELL5 X4"}) {
      store({"LINEAR ABS TM60 TA20 TS0", "X1", "X2", "X3", behind});
      for (std::uint32_t seed = 1; seed <= 30; ++seed) {
        SCOPED_TRACE(std::string(order) + " " + behind + ", seed " + std::to_string(seed));
        ASSERT_EQ(host("#1HMZ"), "");
        begin();
        ticks(1 + seed * 13 % ticks_of(180));
        interrupted(seed, 50 + seed % 5 * 200, [&] {
          fake_interrupts_leave_time();  // segments that are late would be an error
          EXPECT_EQ(host(order), "");
        });
        ticks(ticks_of(500));
        ASSERT_FALSE(run_is_running(0));
        const double corner = at(1) / 1000;
        ASSERT_TRUE(corner == 1 || corner == 2 || corner == 3 || corner == 4) << at(1);
        ++corners[static_cast<unsigned>(corner) - 1];
        for (int i = 0; i < 5 && at(1) != 4000; ++i) {
          ASSERT_EQ(host("R"), "");
          ticks(ticks_of(500));
        }
        ASSERT_EQ(motors[0].trajectory, 4000 * 3072);
        ASSERT_LT(longest_step, 21 * kTickMs);
      }
    }
  for (unsigned i = 0; i < 3; ++i) EXPECT_GT(corners[i], 5u) << i + 1;
}

// A program ends or fails between what a stop looks at and what it asks for: nothing is left of the stop.
TEST_F(InterruptsOfMoves, AStopOfWhatHasEndedLeavesNothing) {
  constexpr unsigned kSeeds = 25;
  for (const char* line :
       {"I5113=5 I5120=40 I5194=8388607 I5195=8388607", "DELETE GATHER", "&1DEFINE LOOKAHEAD 100,10"})
    ASSERT_EQ(host(line), "");
  store({"LINEAR ABS TM10 TA5 TS0", "X0.1"});
  unsigned ended = 0, stopped = 0;
  for (const bool fails : {false, true})
    for (const char order : {'Q', '/', '\\'})
      for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
        SCOPED_TRACE(std::string(1, order) + (fails ? ", fails" : "") + ", seed " + std::to_string(seed));
        ASSERT_EQ(host("#1HMZ"), "");
        ASSERT_EQ(host("%100"), "");
        begin();
        while (!fails && cs().active) ticks(1);
        if (fails) {  // and settles at once, because nothing moves
          ASSERT_EQ(host("%0"), "");
          ticks(3);
          cs().failure = RUN_TIME_BY_USER;
        }
        interrupted(seed, 1000, [&] {
          fake_interrupts_soon();
          fake_hal_slices_leave(false);
          if (order == 'Q') run_quit(0);
          if (order == '/') run_end_block(0);
          if (order == '\\') run_stop_on_path(0);
        });
        (run_is_running(0) ? stopped : ended)++;
        ticks(12);
        ASSERT_FALSE(cs().quit);
        if (order == '\\') { ASSERT_EQ(cs().must_return, cs().held || run_is_running(0)); }
        ASSERT_EQ(cs().error, fails ? RUN_TIME_BY_USER : RUN_TIME_NONE);
        ASSERT_EQ(host("A"), "");
        ticks(12);
      }
  EXPECT_GT(ended, 20u);
  EXPECT_GT(stopped, 3u);
}

// A program fails while R looks at it: its motors come to rest on their ramps, and it is not begun anew.
TEST_F(InterruptsOfMoves, AStartTakesNoMotorFromItsRamp) {
  ASSERT_EQ(host("I5195=20000"), "");
  store({"LINEAR INC TM200 TA40 TS0", "X4", "X4"});
  for (const bool held : {false, true})
    for (std::uint32_t seed = 1; seed <= 40; ++seed) {
      SCOPED_TRACE((held ? "held, seed " : "seed ") + std::to_string(seed));
      ASSERT_EQ(host("#1HMZ"), "");
      begin();
      ticks(ticks_of(60));
      longest_change = 0;
      if (held) {
        ASSERT_EQ(host("H"), "");
        ticks(ticks_of(20));
      }
      cs().failure = RUN_TIME_BY_USER;
      interrupted(seed, 10 * seed, [] {
        fake_hal_slices_leave(false);
        fake_interrupts_on_take([](fake_task task) {
          look_at_step(task);
          hal_request_real_time();
        });
        const error_t refused = run_start(0, false);
        EXPECT_TRUE(refused == ERR_NONE || refused == ERR_MOVE_IN_PROGRESS);
      });
      ticks(ticks_of(100));
      ASSERT_FALSE(run_is_running(0));
      ASSERT_EQ(cs().error, RUN_TIME_BY_USER);
      ASSERT_LT(longest_change, 1.5 * kTickMs * kTickMs) << "Ixx15, TA";
    }
}

}  // namespace
