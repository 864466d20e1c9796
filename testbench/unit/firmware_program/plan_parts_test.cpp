// Parts of the planning of moves by themselves: the shape of a change of velocity, corners that do not blend, and where
// a motor's present motion ends.
#include <cmath>

#include "testbench/unit/firmware_program/moving_motors.h"

extern "C" {
#include "firmware/motion/corner.h"
#include "firmware/motion/jog.h"
#include "firmware/motion/motor_target.h"
#include "firmware/motion/system_motors.h"
#include "firmware/motion/velocity_change.h"
}

namespace {

using moving_motors::host;
using moving_motors::kUnit;
using moving_motors::MovingMotors;
using moving_motors::risen;

// The way of a velocity that rises from 0 to 1, S-shaped at both ends, as a part of its length (motion:5.2).
TEST(VelocityChange, ItsPartsAreCubicsOfTheSCurve) {
  for (const double length : {1.0, 40.0, 1000.0})
    for (const double share : {0.0, 0.001, 0.1, 0.25, 0.4, 0.499, 0.5, 0.7}) {
      SCOPED_TRACE(::testing::Message() << share << " of " << length);
      const auto units = static_cast<std::int64_t>(length * 8388608);
      const auto s_units = static_cast<std::int64_t>(share * length * 8388608);
      const double s = std::min(share, 0.5) * length;
      velocity_part parts[VELOCITY_PARTS];
      const unsigned count = velocity_change(units, s_units, parts);
      ASSERT_EQ(count, share == 0.0 ? 1u : share >= 0.5 ? 2u : 3u);
      std::int64_t time = 0;
      double at = 0, before = 0;
      for (unsigned i = 0; i < count; ++i) {
        const velocity_part& p = parts[i];
        EXPECT_GT(p.time, 0);
        const double lasts = static_cast<double>(p.time) / static_cast<double>(units);
        const double linear = p.risen - before - p.square - p.cube;
        for (const double u : {0.0, 0.25, 0.5, 0.75, 1.0})
          EXPECT_NEAR(before + linear * u + p.square * u * u + p.cube * u * u * u,
                      risen((at + u * lasts) * length, length, s) / length, 1e-7)
              << i << " at " << u;
        time += p.time;
        at += lasts;
        EXPECT_NEAR(p.at, at, 1e-6);
        before = p.risen;
      }
      EXPECT_EQ(time, units);
      EXPECT_EQ(parts[count - 1].at, 1.0);
      EXPECT_EQ(parts[count - 1].risen, 0.5);
    }
  velocity_part parts[VELOCITY_PARTS];
  EXPECT_EQ(velocity_change(0, 0, parts), 0u);
  EXPECT_EQ(velocity_change(0, 100, parts), 0u);
  EXPECT_EQ(velocity_change(-5, 0, parts), 0u);
}

class Corners : public MovingMotors {
 protected:
  struct Found {
    bool sharp, dwells;
  };
  static Found judge(const std::vector<std::pair<unsigned, double>>& before,
                     const std::vector<std::pair<unsigned, double>>& after) {
    double from[AXIS_COUNT] = {}, to[AXIS_COUNT] = {};
    for (const auto& [axis, way] : before) from[axis] = way;
    for (const auto& [axis, way] : after) to[axis] = way;
    Found found = {false, false};
    found.sharp = corner_is_sharp(0, from, to, &found.dwells);
    return found;
  }
};

// motion:5.3: by the cosine of the change of direction of X, Y and Z below Isx83, 0 for none; Isx82 counts where it is
// below Isx85.
TEST_F(Corners, AreSharpByTheirCosine) {
  for (const double isx83 : {0.0, 0.5, -0.5, 0.95})
    for (const double isx85 : {0.0, 0.3, -0.8}) {
      ASSERT_EQ(host("I5183=" + std::to_string(isx83) + " I5185=" + std::to_string(isx85)), "");
      for (int degrees = 5; degrees <= 180; degrees += 10) {
        const double angle = degrees * 3.14159265358979 / 180, x = std::cos(angle), y = std::sin(angle);
        const Found turns[] = {
            judge({{AXIS_X, 3}}, {{AXIS_X, 20 * x}, {AXIS_Y, 20 * y}}),
            judge({{AXIS_Y, -7}}, {{AXIS_Y, -0.1 * x}, {AXIS_Z, 0.1 * y}}),
            judge({{AXIS_Z, 1}, {AXIS_A, 50}}, {{AXIS_Z, x}, {AXIS_X, y}, {AXIS_A, -50}, {AXIS_U, 9}})};
        const bool sharp = isx83 != 0 && x < isx83;
        for (const Found& found : turns) {
          EXPECT_EQ(found.sharp, sharp) << degrees << " " << isx83;
          EXPECT_EQ(found.dwells, sharp && x < isx85) << degrees << " " << isx85;
        }
      }
      EXPECT_FALSE(judge({{AXIS_X, 1}}, {{AXIS_A, 5}}).sharp) << "no direction";
      EXPECT_FALSE(judge({{AXIS_W, 1}}, {{AXIS_Y, 5}}).sharp);
      EXPECT_FALSE(judge({}, {}).sharp);
    }
}

// motion:5.3, firmware:7.10: into position within Isx81 real-time interrupts, else error 10; then Isx82 of them, at a
// corner that asks for it.
TEST_F(Corners, WaitForThePositionAndThePause) {
  fit({"1000X", "1000Y"});
  coordinate_system& s = cs();
  system_motors_resolve(0);
  move& next = s.moves[s.executing ^ 1u];
  const auto set_up = [&](unsigned isx81, unsigned isx82, bool dwells) {
    ASSERT_EQ(host("I5181=" + std::to_string(isx81) + " I5182=" + std::to_string(isx82)), "");
    next = {};
    next.has_dwell = dwells;
    s.first = s.active = false;
    s.corner = CORNER_NONE;
    s.failure = RUN_TIME_NONE;
    motors[0].found.in_position = motors[1].found.in_position = true;
    cs_interrupts = 0xFFFFFFFE;  // it comes round
  };
  const auto waits_for = [&](unsigned limit) {  // interrupts that it waits
    unsigned n = 0;
    for (; n < limit && corner_waits(0); ++n) ++cs_interrupts;
    return n;
  };
  for (const unsigned isx82 : {0u, 1u, 7u})
    for (const bool dwells : {false, true})
      for (const unsigned isx81 : {0u, 5u}) {
        SCOPED_TRACE(::testing::Message() << isx81 << ", " << isx82 << ", " << dwells);
        ASSERT_NO_FATAL_FAILURE(set_up(isx81, isx82, dwells));
        EXPECT_EQ(waits_for(50), dwells ? isx82 : 0u);
        EXPECT_EQ(s.corner, CORNER_NONE);
        EXPECT_EQ(s.failure, RUN_TIME_NONE);
        ASSERT_NO_FATAL_FAILURE(set_up(isx81, isx82, dwells));
        motors[1].found.in_position = false;
        EXPECT_EQ(waits_for(5), isx81 != 0 ? 5u : dwells ? std::min(isx82, 5u) : 0u);
        EXPECT_EQ(s.failure, RUN_TIME_NONE) << "Isx81 has not passed";
        if (isx81 == 0) continue;
        EXPECT_EQ(s.corner, CORNER_IN_POSITION);
        EXPECT_TRUE(corner_waits(0));
        EXPECT_EQ(s.failure, RUN_TIME_IN_POSITION);
      }
  ASSERT_NO_FATAL_FAILURE(set_up(5, 7, true));
  motors[0].found.in_position = false;
  EXPECT_EQ(waits_for(3), 3u);
  motors[0].found.in_position = true;
  EXPECT_EQ(waits_for(50), 7u) << "the pause begins with the position";
  for (int none = 0; none < 2; ++none) {
    ASSERT_NO_FATAL_FAILURE(set_up(5, 7, true));
    (none == 0 ? next.joins : s.first) = true;
    EXPECT_FALSE(corner_waits(0)) << "no corner";
  }
  ASSERT_NO_FATAL_FAILURE(set_up(5, 7, true));
  s.active = true;
  EXPECT_EQ(waits_for(30), 30u) << "the move before";
  EXPECT_EQ(s.corner, CORNER_NONE);
  s.active = false;
  EXPECT_EQ(waits_for(50), 7u);
}

// motion:1.3/3: the end of a jog or of a LINEAR move, of another that of the piece which executes, else where it is.
class MotorTarget : public MovingMotors {};

TEST_F(MotorTarget, IsTheEndOfItsMotion) {
  fit({"1000X", "1000Y", "1000Z"});
  motors[0].trajectory = 500;
  EXPECT_EQ(motor_target(0), 500) << "it stands";
  ASSERT_EQ(host("I119=0.25 I120=0 I121=50 I122=20 I192=1 #1J:100"), "");
  EXPECT_EQ(motor_target(0), 500) << "planned later";
  platform::servo_ticks(20);
  EXPECT_EQ(motor_target(0), 500 + 100 * 3072);
  ASSERT_EQ(host("#1J+"), "");
  platform::servo_ticks(20);
  EXPECT_EQ(motor_target(0), motors[0].trajectory) << "without an end";
  ASSERT_EQ(host("#1K"), "");
  fit({"1000X", "1000Y", "1000Z"});
  store({"ABS TM200 TA100 TS0 X1 Y-2", "X3 Y-2", "DWELL50", "PVT100", "X4:0 Y-2:0", "X5:0 Z1:0"});
  ASSERT_EQ(host("&1B1R"), "");
  const auto expect = [](double x, double y, double z, const char* when) {
    EXPECT_NEAR(static_cast<double>(motor_target(0)), x * kUnit, 1) << when;
    EXPECT_NEAR(static_cast<double>(motor_target(1)), y * kUnit, 1) << when;
    EXPECT_NEAR(static_cast<double>(motor_target(2)), z * kUnit, 1) << when;
  };
  for (int i = 0; i < 1000 && !cs().active; ++i) platform::servo_ticks(1);
  const auto wait = [](double ms) { platform::servo_ticks(moving_motors::ticks_of(ms)); };
  wait(60);
  expect(1000, -2000, 0, "accelerating");
  wait(120);
  expect(1000, -2000, 0, "before the blend");
  wait(60);
  expect(3000, -2000, 0, "in it");
  wait(290);
  expect(3000, -2000, 0, "DWELL");
  wait(60);
  expect(4000, -2000, 0, "PVT");
  wait(90);
  expect(5000, -2000, 1000, "the next");
  wait(300);
  ASSERT_FALSE(run_is_running(0));
  expect(5000, -2000, 1000, "it stands there");
  piece_ring& ring = cs().ring;
  ASSERT_TRUE(piece_ring_is_empty(&ring));
  cs().active = true;  // and the ring has run empty
  motors[0].path = PATH_SYSTEM;
  piece_ring_at(&ring, ring.executing)->motors = 1;
  piece_ring_cubic(&ring, ring.executing, 0)->start = 99;
  cs().moves[cs().executing].kind = MOVE_DWELL;
  expect(5000, -2000, 1000, "what is over is no piece");
}

}  // namespace
