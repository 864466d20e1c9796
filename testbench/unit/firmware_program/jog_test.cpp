// Jogs as the servo task moves along them, against motions integrated in double precision (motion:4.1, motion:4.2):
// within 1/16 count at each servo interrupt, exact at the end.
#include <random>

#include "testbench/unit/firmware_program/jog_model.h"
#include "testbench/unit/firmware_program/platform.h"
#include "testbench/unit/random_seed.h"

extern "C" {
#include "firmware/motion/jog.h"
#include "firmware/motion/jog_plan.h"
#include "firmware/motion/jog_servo.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/motor_state.h"
#include "firmware/motion/speed_profile.h"
extern volatile std::uint32_t jogs_asked;  // jog_state.h: motors whose request is not planned yet
}

namespace {

using jog_model::Limits;
using jog_model::Motion;
using jog_model::State;

constexpr double kUnits = 32 * 96;        // of a count: 32 Ixx08
constexpr double kTimeUnits = 8388608.0;  // of a ms
constexpr double kTolerance = 1.0 / 16;

class Jog : public FirmwareTest {
 protected:
  void SetUp() override {
    FirmwareTest::SetUp();
    ASSERT_EQ(platform::host("I100=1"), "");
    motors[0].position_scale = 96;
    motors[0].loop = LOOP_CLOSED;
    motors[0].trajectory = 0;
    increment(platform::kDefaultI10);
  }

  static void increment(std::int32_t units) {
    coordinate_systems[0].increment = coordinate_systems[0].increment_target = units;
    coordinate_systems[0].increment_command = coordinate_systems[0].increment_full = units;
    coordinate_systems[0].increment_slew = INT32_MAX;
  }

  static void set(const Limits& l, unsigned ixx92) {
    platform::set_i(119, l.ixx19);
    platform::set_i(120, l.ixx20);
    platform::set_i(121, l.ixx21);
    platform::set_i(122, l.ixx22);
    platform::set_i(192, ixx92);
  }

  // One servo interrupt, the real-time task behind it.
  static double step() {
    jog_servo(0);
    while (jog_plan()) {}
    return position();
  }
  static double position() { return static_cast<double>(motors[0].trajectory) / kUnits; }
  static double step_ms() { return coordinate_systems[0].increment / kTimeUnits; }
  static std::int64_t units(double counts) { return std::llround(counts * kUnits); }
};

// Follows `motion`, which begins `delay` ms from now, for `steps` servo interrupts; before that `before` goes on.
struct Followed {
  double worst = 0;
  unsigned moving = 0;
};

class JogProfile : public Jog {
 protected:
  static void follow(const Motion& before, double before_elapsed, const Motion& motion, double delay, unsigned steps,
                     Followed& result) {
    for (unsigned i = 1; i <= steps; ++i) {
      const double now = i * step_ms(), t = now - delay;
      const double expected = t < 0 ? before.at(before_elapsed + now).position : motion.at(t).position;
      const double is = step();
      result.worst = std::max(result.worst, std::abs(is - expected));
      result.moving += std::abs(motion.at(t).speed) > 0;
      ASSERT_NEAR(is, expected, kTolerance) << "interrupt " << i << ", " << t << " ms into the motion";
    }
  }

  static Limits random_limits(std::mt19937& random) {
    std::uniform_real_distribution<> log(-3, 0), speed(-1, 2);
    std::uniform_int_distribution<> pick(0, 3), time(0, 400), s(0, 150);
    Limits l{std::pow(10, log(random)), 0, 0, std::pow(10, speed(random))};
    if (pick(random) != 0) l.ixx21 = s(random);
    if (pick(random) == 0) l.ixx20 = time(random);
    return l;
  }

  static void random_moves(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<> unit(0, 1), duration(-1, 4.3);
    Followed result;
    unsigned moves = 0;
    State at{0, 0};
    while (moves < 10000) {
      const Limits l = random_limits(random);
      const Motion rest({at.position, 0});
      Motion before = rest;
      double elapsed = 0;
      for (unsigned turn = 0; turn < 1 + random() % 3; ++turn, ++moves) {
        const double way = (unit(random) < 0.5 ? -1 : 1) * l.ixx22 * std::pow(10, duration(random));
        const double target = std::round((at.position + way) * 32) / 32;
        const double ms = std::min((std::abs(way) / l.ixx22 + 2 * jog_model::change_time(l, l.ixx22)) / 40, 200.0);
        increment(static_cast<std::int32_t>(ms * kTimeUnits));
        const unsigned ixx92 = 1 + static_cast<unsigned>(3 * ms) + random() % 20;  // planning takes two interrupts
        set(l, ixx92);
        const State from = before.at(elapsed + ixx92);
        const bool steady = unit(random) < 0.1;
        const Motion motion =
            steady ? jog_model::at_speed(l, from, way < 0 ? -l.ixx22 : l.ixx22) : jog_model::to_target(l, from, target);
        ASSERT_TRUE(steady ? jog_continuous(0, way < 0 ? -1 : 1) : jog_to(0, units(target)));
        const unsigned steps = 10 + random() % 40;
        follow(before, elapsed, motion, ixx92, steps, result);
        if (HasFatalFailure()) {
          FAIL() << "move " << moves << " from " << from.position << " at " << from.speed << " to " << target
                 << ", Ixx19 to 22: " << l.ixx19 << " " << l.ixx20 << " " << l.ixx21 << " " << l.ixx22;
        }
        elapsed = steps * step_ms() - ixx92;
        before = motion;
        if (elapsed < 0) break;
      }
      ASSERT_TRUE(jog_to(0, units(at.position)));
      increment(2000000000);
      for (unsigned i = 0; i < 100000 && jog_is_moving(0); ++i) step();
      ASSERT_EQ(motors[0].trajectory, units(at.position)) << "exact at the end";
      ASSERT_FALSE(jog_is_moving(0));
    }
    EXPECT_GT(result.moving, 100000u);
    RecordProperty("worst_counts", std::to_string(result.worst));
  }
};

TEST_F(JogProfile, CheckOfTheDataSheetTakes200And400Ms) {
  const Limits l{0.25, 100, 0, 50};
  EXPECT_DOUBLE_EQ(jog_model::change_time(l, 50), 200);
  EXPECT_DOUBLE_EQ(jog_model::change_time(l, 100), 400);
  set(l, 10);
  ASSERT_TRUE(jog_continuous(0, 1));
  const Motion rest({0, 0}), up = jog_model::at_speed(l, {0, 0}, 50);
  Followed result;
  follow(rest, 0, up, 10, 1000, result);
  const double elapsed = 1000 * step_ms() - 10;
  ASSERT_TRUE(jog_continuous(0, -1));
  const Motion down = jog_model::at_speed(l, up.at(elapsed + 10), -50);
  EXPECT_DOUBLE_EQ(down.time(), 400);
  follow(up, elapsed, down, 10, 2000, result);
  EXPECT_GT(result.moving, 2500u);
}

TEST_F(JogProfile, RandomMovesAndNewTargetsOnTheWayStayWithinASixteenthOfACount) {
  random_moves(brick::random_seed(22));
}

// Targets that come while the speed is next to nothing: what BRICK_RANDOM_SEED=206575656 made of the one above.
TEST_F(JogProfile, RandomMovesOfWhichSomeBeginNextToRest) { random_moves(1233691278u); }

// motion:4.2/2: the present speed is what a change begins with, however small it is and however short the S it is on.
TEST_F(JogProfile, LongChangesBeginAtTheVerySpeedOfAShortOne) {
  Followed result;
  for (const double speed : {0.0001, 0.0053}) {
    const Limits quick{1, 0, 2, speed}, slow{1, 2000, 0, 0.02};
    for (unsigned quarters = 0; quarters < 12; ++quarters) {  // of a ms on the S of 4 ms, 1 ms before the change
      increment(static_cast<std::int32_t>(0.25 * kTimeUnits));
      const State at{position(), 0};
      const Motion first = jog_model::at_speed(quick, at, speed);
      set(quick, 1);
      ASSERT_TRUE(jog_continuous(0, 1));
      follow(Motion(at), 0, first, 1, 4 + quarters, result);
      const Motion second = jog_model::at_speed(slow, first.at(0.25 * quarters + 1), slow.ixx22);
      set(slow, 1);
      ASSERT_TRUE(jog_continuous(0, 1));
      follow(first, 0.25 * quarters, second, 1, 4, result);
      increment(static_cast<std::int32_t>(20 * kTimeUnits));
      follow(second, 0, second, 0, 100, result);
      if (HasFatalFailure()) FAIL() << speed << " counts a ms, after " << quarters << " quarters of a ms";
      jog_drop(0);
    }
  }
}

TEST_F(JogProfile, EndlessJogKeepsItsSpeedForHours) {
  const Limits l{1, 0, 10, 0.1234567};
  set(l, 10);
  increment(INT32_MAX / 2);  // 128 ms
  ASSERT_TRUE(jog_continuous(0, -1));
  Followed result;
  follow(Motion({0, 0}), 0, jog_model::at_speed(l, {0, 0}, -l.ixx22), 3 * step_ms(), 200000, result);
  EXPECT_LT(position(), -3e6);
}

// Ixx92 at its largest: what a new motion begins with is looked for 1023 parts of the stay ahead.
TEST_F(JogProfile, StopThatWaitsForHoursBeginsWhereTheMotorIs) {
  Limits l{1, 0, 10, 0.1234567};
  set(l, 10);
  increment(INT32_MAX / 2);  // 128 ms
  ASSERT_TRUE(jog_continuous(0, 1));
  Followed result;
  const Motion steady = jog_model::at_speed(l, {0, 0}, l.ixx22);
  follow(Motion({0, 0}), 0, steady, 3 * step_ms(), 10, result);
  const double elapsed = 7 * step_ms(), ixx92 = 8388607;
  set(l, 8388607);
  ASSERT_TRUE(jog_stop(0));
  follow(steady, elapsed, jog_model::at_speed(l, steady.at(elapsed + ixx92), 0), ixx92, 65540, result);
  EXPECT_FALSE(jog_is_moving(0));
}

TEST_F(JogProfile, LongMoveAtASmallSpeedStaysWithinASixteenthOfACount) {
  const Limits l{1, 0, 10, 0.7};
  set(l, 400);
  increment(INT32_MAX / 2);
  ASSERT_TRUE(jog_to(0, units(1000000.25)));
  Followed result;
  follow(Motion({0, 0}), 0, jog_model::to_target(l, {0, 0}, 1000000.25), 400, 12000, result);
  EXPECT_EQ(motors[0].trajectory, units(1000000.25));
  EXPECT_FALSE(jog_is_moving(0));
}

// A stay is parts of 8192 ms and what is left: asked for in the second of three, begun behind them.
TEST_F(JogProfile, AStopBeginsBehindTheLastWholePartOfAStay) {
  const Limits l{1, 0, 10, 1};
  set(l, 400);
  increment(INT32_MAX / 2);  // 128 ms
  ASSERT_TRUE(jog_to(0, units(30000)));
  Followed result;
  const Motion way = jog_model::to_target(l, {0, 0}, 30000);
  follow(Motion({0, 0}), 0, way, 400, 105, result);
  const double elapsed = 105 * step_ms() - 400, ixx92 = 12000;
  ASSERT_TRUE(elapsed > 8192 + 20 && elapsed < 2 * 8192 && elapsed + ixx92 > 3 * 8192 + 20);
  set(l, 12000);
  ASSERT_TRUE(jog_stop(0));
  follow(way, elapsed, jog_model::at_speed(l, way.at(elapsed + ixx92), 0), ixx92, 115, result);
  EXPECT_FALSE(jog_is_moving(0));
}

// motion:4.1/3
TEST_F(JogProfile, NoChangeTakesLongerThan2To23Ms) {
  const Limits l{1e-12, 0, 400, 20};
  set(l, 10);
  increment(INT32_MAX / 2);  // 128 ms
  ASSERT_TRUE(jog_continuous(0, 1));
  for (unsigned i = 0; i < 65536 + 100; ++i) step();
  const double before = position();
  step();
  EXPECT_NEAR(position() - before, 20 * step_ms(), kTolerance);
  // Symmetric: half of the last speed on the average.
  const double since = 65536.0 * step_ms() + 101 * step_ms() - 3 * step_ms();
  EXPECT_NEAR(position(), 20.0 * 8388608.0 / 2 + 20 * (since - 8388608.0), 20 * step_ms());
}

// Ixx19 counts as 30 / 2^23: from 20 to 10 counts a ms in a third of 2^23 ms.
TEST_F(JogProfile, TheSlowestAccelerationIsThatOfBothSpeeds) {
  const Limits quick{1, 0, 0, 20}, least{30 / 8388608.0, 0, 0, 10};
  set(quick, 10);
  ASSERT_TRUE(jog_continuous(0, 1));
  for (int i = 0; i < 100; ++i) step();
  const State at{position(), 20};
  set({1e-12, 0, 0, 10}, 400);
  increment(INT32_MAX / 2);  // 128 ms
  ASSERT_TRUE(jog_continuous(0, 1));
  Followed result;
  const Motion slower = jog_model::at_speed(least, {at.position + 20 * 400, 20}, 10);
  EXPECT_DOUBLE_EQ(slower.time(), 8388608.0 / 3);
  follow(Motion(at), 0, slower, 400, 22000, result);
}

// Faster ones would not fit into a word.
TEST_F(JogProfile, SpeedsEndAt2To31UnitsAMs) {
  for (const double sign : {1.0, -1.0}) {
    platform::set_i(119, 1e20);
    platform::set_i(120, 1);
    platform::set_i(121, 0);
    platform::set_i(192, 1);
    ASSERT_TRUE(jog_home(0, sign * 1e20, 0, 0));
    for (int i = 0; i < 20; ++i) step();
    const double before = position();
    step();
    EXPECT_NEAR(position() - before, sign * 2147483648.0 / kUnits * step_ms(), 1.0);
    jog_drop(0);
  }
}

TEST_F(JogProfile, RampStopsAtOneDeceleration) {
  const Limits l{0.25, 0, 50, 20};
  set(l, 10);
  ASSERT_TRUE(jog_continuous(0, 1));
  for (int i = 0; i < 1000; ++i) step();
  const State at{position(), 20};
  ASSERT_TRUE(jog_stop_at(0, 0.5));
  std::vector<double> positions;
  while (jog_is_moving(0)) {
    positions.push_back(step());
    if (positions.size() == 5) { EXPECT_TRUE(motors[0].status.aborting); }
  }
  EXPECT_FALSE(motors[0].status.aborting);
  const double begins = (position() - at.position - 20 * 20 / (2 * 0.5)) / 20;  // ms after the request
  EXPECT_GE(begins, 0);
  EXPECT_LE(begins, 3.01 * step_ms()) << "Ixx92 does not count";
  Motion ramp({at.position + 20 * begins, 20});
  ramp.ramp(0.5);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double now = static_cast<double>(i + 1) * step_ms(), t = now - begins;
    ASSERT_NEAR(positions[i], t < 0 ? at.position + 20 * now : ramp.at(t).position, kTolerance) << i;
  }
  EXPECT_GT(positions.size(), 90u) << "40 ms";
}

// motion:4.5/1: no ramp lasts 2^23 ms. What would is none.
TEST_F(JogProfile, ARampWithoutADecelerationStopsOnTheSpot) {
  for (const double ixx15 : {0.0, 19.9 / 8388608.0, 20.1 / 8388608.0}) {
    set({0.25, 0, 50, 20}, 10);
    ASSERT_TRUE(jog_continuous(0, 1));
    for (int i = 0; i < 1000; ++i) step();
    ASSERT_TRUE(jog_stop_at(0, ixx15));
    for (int i = 0; i < 4; ++i) step();
    const double before = position(), ramps = ixx15 * 8388608.0 > 20 ? 20 : 0;
    EXPECT_NEAR(step() - before, ramps * step_ms(), kTolerance) << ixx15;
    EXPECT_EQ(jog_is_moving(0), ramps != 0);
    jog_drop(0);
  }
}

// Protection asks again in each of its passes: the ramp that is under way, or about to be, goes on.
TEST_F(JogProfile, ARampThatIsAskedForAgainGoesOn) {
  set({0.25, 0, 50, 20}, 10);
  ASSERT_TRUE(jog_continuous(0, 1));
  for (int i = 0; i < 1000; ++i) step();
  const double before = position();
  unsigned steps = 0;
  for (; steps < 500 && jog_is_moving(0); ++steps) {
    ASSERT_TRUE(jog_stop_at(0, 0.5));
    EXPECT_TRUE(hal_real_time_pending() || steps > 0) << "it does not wait for its turn";
    const double last = position();
    jog_servo(0);
    if (last == position() && steps > 10) break;
    while (jog_plan()) {}
  }
  EXPECT_NEAR(steps, 20 / 0.5 / step_ms(), 8);
  EXPECT_NEAR(position() - before, 20 * 20 / 0.5 / 2, 20 * 4 * step_ms());
}

TEST_F(JogProfile, RampAtZeroPercentStopsOnTheSpot) {
  set({0.25, 0, 50, 20}, 10);
  ASSERT_TRUE(jog_continuous(0, 1));
  for (int i = 0; i < 1000; ++i) step();
  increment(0);
  step();
  const std::int64_t before = motors[0].trajectory;
  ASSERT_TRUE(jog_stop_at(0, 0.5));
  step();
  EXPECT_FALSE(jog_is_moving(0));
  EXPECT_EQ(motors[0].trajectory, before);
}

TEST_F(Jog, TimeIsThatOfTheCoordinateSystem) {
  set({0.25, 0, 50, 20}, 10);
  platform::set_i(122, 10);
  increment(platform::kDefaultI10 / 2);
  ASSERT_TRUE(jog_continuous(0, 1));
  for (int i = 0; i < 2000; ++i) step();
  const double before = position();
  for (int i = 0; i < 100; ++i) step();
  EXPECT_NEAR(position() - before, 100 * (platform::kDefaultI10 / 2.0) / kTimeUnits * 10, kTolerance) << "50 %";
  motors[0].cs = 1;
  coordinate_systems[1].increment = platform::kDefaultI10 / 4;
  coordinate_systems[1].increment_slew = INT32_MAX;
  step();
  const double other = position();
  for (int i = 0; i < 100; ++i) step();
  EXPECT_NEAR(position() - other, 100 * (platform::kDefaultI10 / 4.0) / kTimeUnits * 10, kTolerance) << "25 % of &2";
}

TEST_F(Jog, HoldStopsWhatAProgramMovesAndNothingElse) {
  set({0.25, 0, 50, 20}, 10);
  for (const bool by_program : {false, true}) {
    ASSERT_TRUE(by_program ? jog_rapid(0, units(1e6), 20, 1) : jog_continuous(0, 1));
    for (int i = 0; i < 1000; ++i) step();
    coordinate_systems[0].held = true;
    coordinate_systems[0].increment = coordinate_systems[0].increment_target = 0;
    for (const int per_cent : {100, 50}) {
      coordinate_systems[0].increment_command = platform::kDefaultI10 * per_cent / 100;
      step();
      const double before = position(), cycles = per_cent;
      for (int i = 0; i < 100; ++i) step();
      EXPECT_NEAR(position() - before, by_program ? 0 : cycles * platform::kDefaultI10 / kTimeUnits * 20, kTolerance);
    }
    coordinate_systems[0].held = false;
    increment(platform::kDefaultI10);
  }
}

TEST_F(Jog, RequestsInARowDoNotHoldOffThoseBefore) {
  set({0.25, 0, 50, 20}, 10);
  for (int i = 0; i < 400; ++i) {
    if (i % 10 == 0) {  // every 4.4 ms
      ASSERT_TRUE(jog_to(0, units(1000 + i)));
    }
    step();
  }
  EXPECT_GT(position(), 100) << "each begins anew at the speed that the last had come to";
  for (int i = 0; i < 2000 && jog_is_moving(0); ++i) step();
  EXPECT_EQ(motors[0].trajectory, units(1390));
}

TEST_F(Jog, PlanningThatTakesTooLongBeginsLaterWithoutAJump) {
  set({0.25, 0, 50, 20}, 1);
  ASSERT_TRUE(jog_continuous(0, 1));
  unsigned interrupts = 0;
  double last = 0, largest = 0;
  const auto servo = [&] {
    jog_servo(0);
    ++interrupts;
    largest = std::max(largest, std::abs(position() - last));
    last = position();
  };
  for (int i = 0; i < 300; ++i) {
    servo();
    if (i == 100) { ASSERT_TRUE(jog_to(0, 0)); }
    const std::function<void()> between = servo;
    if (i % 3 == 0) platform::real_time_in_slices(between);
  }
  EXPECT_GT(interrupts, 500u) << "most of them while it is planned";
  for (int i = 0; i < 5000 && jog_is_moving(0); ++i) {
    servo();
    platform::real_time();
  }
  EXPECT_EQ(motors[0].trajectory, 0);
  EXPECT_LT(largest, 20 * step_ms() * 1.01) << "never faster than Ixx22";
}

// Positions that are counted from elsewhere while a motion is planned: it is planned again.
TEST_F(Jog, CountedFromElsewhereWhileItIsPlanned) {
  set({0.25, 0, 50, 20}, 1);
  for (int when = 1; when < 60; ++when) {
    motors[0].trajectory = 0;
    ASSERT_TRUE(jog_to(0, units(1000)));
    int pauses = 0;
    double last = 0, largest = 0;
    for (int i = 0; i < 2000 && jog_is_moving(0); ++i) {
      jog_servo(0);
      largest = std::max(largest, std::abs(position() - last));
      last = position();
      platform::real_time_in_slices([&] {
        if (++pauses != when) return;
        const std::uint32_t state = hal_mask_servo();
        jog_count_from(0, units(100), 0);
        hal_unmask(state);
        last -= 100;
      });
    }
    ASSERT_EQ(motors[0].trajectory, units(900)) << when;
    ASSERT_LT(largest, 20 * step_ms() * 1.01) << when << ": without a jump";
  }
}

// motion:4.1: 2^23 ms are the longest change, however small Ixx19 is; half of them take it half as far.
TEST_F(Jog, NoChangeTakesLongerThanAWordOfMilliseconds) {
  const auto change = [](double ixx19, double speed) {
    const speed_limits l = speed_limits_make(ixx19, 50, 20);
    return speed_change_time(&l, 0, speed);
  };
  EXPECT_EQ(change(0, 1), 8388608);
  EXPECT_EQ(change(1.0 / 16777216, 1), 8388608);
  EXPECT_EQ(change(1.0 / 4194304, 1), 4194304 + 20);
  const speed_limits longer = speed_limits_make(1.0 / 8388608, 50, 0.5);
  EXPECT_EQ(speed_change_time(&longer, 0, 1), 8388608) << "of half a ms more";
  EXPECT_EQ(change(1, 20), 50);
  EXPECT_EQ(change(1, 31), 51);
}

// Two changes at once while a motion is planned are no less than one: what it was planned for is over.
TEST_F(Jog, TwoChangesWhileItIsPlanned) {
  const std::function<void()> changes[] = {[] { jog_count_from(0, units(100), 0); }, [] { jog_drop(0); },
                                           [] { jog_program_takes(0); }};
  set({0.25, 0, 50, 20}, 1);
  for (const auto& change : changes)
    for (int when = 1; when < 60; ++when) {
      motors[0].trajectory = 0;
      motors[0].path = PATH_STANDS;
      ASSERT_TRUE(jog_to(0, units(1000)));
      int pauses = 0;
      for (int i = 0; i < 2000 && jog_is_moving(0); ++i) {
        jog_servo(0);
        platform::real_time_in_slices([&] {
          if (++pauses != when) return;
          const std::uint32_t state = hal_mask_servo();
          change();
          hal_unmask(state);
          ASSERT_TRUE(jog_to(0, units(300)));
        });
      }
      ASSERT_GE(pauses, when);
      ASSERT_EQ(motors[0].trajectory, units(300)) << when;
    }
}

TEST_F(Jog, KilledMotorStandsAndTakesNoRequest) {
  set({0.25, 0, 50, 20}, 10);
  ASSERT_TRUE(jog_continuous(0, 1));
  for (int i = 0; i < 300; ++i) step();
  motors[0].loop = LOOP_KILLED;
  const double before = step();
  EXPECT_FALSE(jog_is_moving(0));
  EXPECT_FALSE(jog_to(0, 0));
  EXPECT_EQ(step(), before);
}

// A request that has been dropped before it was planned comes back with none of those behind it.
TEST_F(Jog, WhatHasBeenDroppedIsForgotten) {
  set({0.25, 0, 50, 20}, 1);
  ASSERT_TRUE(jog_to(0, units(1000)));
  jog_drop(0);
  for (int i = 0; i < 20; ++i) step();
  ASSERT_TRUE(jog_to(0, units(-1000)));
  double highest = -1000;
  for (int i = 0; i < 2000 && jog_is_moving(0); ++i) highest = std::max(highest, step());
  EXPECT_LE(highest, 0);
  EXPECT_EQ(motors[0].trajectory, units(-1000));
}

// Nor one that is dropped at any pause while it is planned.
TEST_F(Jog, WhatIsDroppedWhileItIsPlannedIsForgotten) {
  set({0.25, 0, 50, 20}, 1);
  unsigned when = 1;
  for (;; ++when) {
    motors[0].trajectory = 0;
    ASSERT_TRUE(jog_to(0, units(1000)));
    unsigned count = 0;
    platform::real_time_in_slices([&] {
      if (++count != when) return;
      const std::uint32_t state = hal_mask_servo();
      jog_drop(0);
      hal_unmask(state);
    });
    if (count < when) break;
    ASSERT_TRUE(jog_to(0, units(-100)));
    double highest = -1;
    for (int i = 0; i < 500 && jog_is_moving(0); ++i) highest = std::max(highest, step());
    EXPECT_LE(highest, 0) << when;
    EXPECT_EQ(motors[0].trajectory, units(-100)) << when;
  }
  EXPECT_GT(when, 10u);
}

// A request at any pause while two are planned that begin together: both begin, the one that is asked for again goes to
// its new place.
TEST_F(Jog, ARequestBehindAMoveThatWaitsForAnother) {
  unsigned pauses = 1;
  for (unsigned at = 1; at <= pauses; ++at) {
    SCOPED_TRACE(at);
    platform::power_up();
    increment(platform::kDefaultI10);
    for (unsigned motor = 0; motor < 2; ++motor) {
      ASSERT_EQ(platform::host("I" + std::to_string(motor + 1) + "00=1"), "");
      motors[motor] = {};
      motors[motor].loop = LOOP_CLOSED;
      motors[motor].position_scale = 96;
      platform::set_i(100 * motor + 119, 1);
      platform::set_i(100 * motor + 120, 0);
      platform::set_i(100 * motor + 121, 0);
      platform::set_i(100 * motor + 192, 1);
      ASSERT_TRUE(jog_rapid(motor, units(100), 20, 3));
    }
    unsigned count = 0;
    platform::real_time_in_slices([&] {
      if (++count != at) return;
      EXPECT_TRUE(jog_rapid(0, units(200), 20, 3));
    });
    pauses = std::max(pauses, count);
    for (int i = 0; i < 400; ++i) {
      for (unsigned motor = 0; motor < 2; ++motor) jog_servo(motor);
      platform::real_time();
    }
    EXPECT_FALSE(jog_is_moving(0) || jog_is_moving(1));
    EXPECT_EQ(motors[0].trajectory, units(count >= at ? 200 : 100));
    EXPECT_EQ(motors[1].trajectory, units(100));
  }
  EXPECT_GT(pauses, 10u);
}

// motion:5.5/1: one whose ramp has taken the place of a move that waited, and which has moved together with another
// before, does not begin what that other waits for.
TEST_F(Jog, ARampInPlaceOfAWaitingMoveBeginsNoOther) {
  for (unsigned motor = 0; motor < 4; ++motor) {
    ASSERT_EQ(platform::host("I" + std::to_string(motor + 1) + "00=1"), "");
    motors[motor] = motors[0];
    platform::set_i(100 * motor + 119, 1);
    platform::set_i(100 * motor + 120, 0);
    platform::set_i(100 * motor + 121, 0);
    platform::set_i(100 * motor + 192, 1);
  }
  const auto rapid = [](unsigned motor, std::uint32_t together) {
    EXPECT_TRUE(jog_rapid(motor, motors[motor].trajectory + units(100), 20, together));
  };
  const auto servo = [](unsigned count) {
    for (unsigned i = 0; i < 4 * count; ++i) jog_servo(i % 4);
  };
  rapid(0, 0b0011);
  rapid(1, 0b0011);
  for (int i = 0; i < 200; ++i) {
    servo(1);
    platform::real_time();
  }
  ASSERT_FALSE(jog_is_moving(0) || jog_is_moving(1));
  const std::int64_t stands = motors[1].trajectory;
  unsigned stage = 0;
  rapid(0, 0b0101);
  rapid(2, 0b0101);
  platform::real_time_in_slices([&] {
    if (stage == 0 && jogs_asked == 0b0100) {  // the first waits for the third
      EXPECT_TRUE(jog_stop_at(0, 1));
      rapid(1, 0b1010);
      stage = 1;
    } else if (stage == 1 && jogs_asked == 0b0010) {  // its ramp is planned, and begins and ends
      servo(5);
      rapid(3, 0b1010);
      stage = 2;
    } else if (stage == 2 && jogs_asked == 0b1000) {  // the second waits for the fourth
      servo(20);
      EXPECT_EQ(motors[1].trajectory, stands);
      stage = 3;
    }
  });
  EXPECT_EQ(stage, 3u);
  servo(20);
  EXPECT_GT(motors[1].trajectory, stands);
  EXPECT_EQ(motors[3].trajectory, motors[1].trajectory - stands);
}

}  // namespace
