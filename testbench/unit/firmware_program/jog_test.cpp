// Jogs as the servo task moves along them, against motions integrated in double precision (datasheet/motion.md,
// section 4): within 1/16 count at each servo interrupt, exact at the end.
#include <random>

#include "testbench/unit/firmware_program/jog_model.h"
#include "testbench/unit/firmware_program/platform.h"

extern "C" {
#include "firmware/motion/jog.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/motor_state.h"
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
  std::mt19937 random(22);
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
      if (steady)
        ASSERT_TRUE(jog_continuous(0, way < 0 ? -1 : 1));
      else
        ASSERT_TRUE(jog_to(0, units(target)));
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

}  // namespace
