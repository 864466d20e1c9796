// Orders on the way (motion:7.5): what is asked for keeps the limits, whatever the program, its segments and the
// buffer.
#include "testbench/unit/firmware_paths/extremes_of_motors.h"

extern "C" {
#include "firmware/motion/coordinate_system.h"
}

namespace {

using namespace moving_motors;

class LookaheadOrderLimits : public ExtremesOfMotors {};

// What orders ask for is limited with Isx20 = 1 too: the stop, the way back to the oldest segment, the way on. 40
// counts a ms at 0.5 counts a ms^2: 80 ms or 1600 counts.
TEST_F(LookaheadOrderLimits, OrdersAreLimitedThoughTheProgramIsNot) {
  constexpr double kFrom = 800, kStop = 40 * 40 / 0.5 / 2;
  for (const int period : {1, 3, 10})
    for (const char* order : {"\\", "<"}) {
      SCOPED_TRACE(order + std::to_string(period));
      platform::power_up();
      fit({"1000X"});
      ASSERT_EQ(host("I5113=" + std::to_string(period) + " I116=50 I117=0.5 I5120=1"), "");
      const int back = 200 / period;  // ms of segments behind
      ASSERT_EQ(host("&1DEFINE LOOKAHEAD " + std::to_string(back + 8) + ",10"), "");
      store({"F40 TA100 TS0", "X60"});
      double end = 0, stands_at = 0;
      unsigned still = 0;
      const auto found = extremes(1, &end, [&](double t) {
        if (t >= kFrom && t < kFrom + kTickMs) { ASSERT_EQ(host(std::string("&1") + order), ""); }
        still = cs().active ? 0 : still + 1;
        if (stands_at != 0 || still < 200) return;
        stands_at = at(1);
        ASSERT_EQ(host("&1>"), "");
      });
      EXPECT_LE(found[0].acceleration, 0.5 * 1.02) << "as programmed 0.4";
      EXPECT_EQ(motors[0].trajectory, 60000 * 3072LL);
      const double ahead = 40 * (kFrom - 50 - period) + kStop, late = 40 * (12 + 2.5 * period);
      EXPECT_GE(stands_at, ahead - (order[0] == '<' ? 40 * 200 : 0));
      EXPECT_LE(stands_at, ahead + late - (order[0] == '<' ? 40 * 100 : 0));
    }
}

// With short segments more of them are handed over than a small buffer keeps behind the front: those whose points have
// been written over are executed, an order takes none of them back.
TEST_F(LookaheadOrderLimits, OrdersTakeBackWhatIsStillStored) {
  for (const int period : {1, 2})
    for (const char* order : {"R", ">", "\\"})
      for (const double when : {0.5, 40.0, 300.0}) {
        SCOPED_TRACE(order + std::to_string(period) + " " + std::to_string(when));
        platform::power_up();
        fit({"1000X"});
        ASSERT_EQ(host("I5113=" + std::to_string(period) + " I116=100 I117=0.5 I5120=40"), "");
        ASSERT_EQ(host("&1DEFINE LOOKAHEAD 24,10"), "");
        store({"F20 TA100 TS0", "X20"});
        double end = 0, last = 0;
        const auto found = extremes(1, &end, [&](double t) {
          if (t >= when && t < when + kTickMs) { ASSERT_EQ(host(std::string("&1") + order), ""); }
          if (t >= when + 200 && t < when + 200 + kTickMs) { ASSERT_EQ(host("&1>"), ""); }
          if (std::abs(at(1) - last) > 20 * 1.005 * kTickMs && !HasFailure()) {
            ADD_FAILURE() << "more than the 20 counts a ms of the program at " << t;
            ASSERT_EQ(host("&1A"), "");
          }
          last = at(1);
        });
        EXPECT_LE(found[0].acceleration, 0.5 * 1.02);
        EXPECT_EQ(motors[0].trajectory, 20000 * 3072LL);
      }
}

// A stop of v^2 / (2 a) is 14.15 and 14.65 segments long, so that a single one begins at the first or third quarter,
// goes to the knot in two parts, and is stopped in the middle, between its quarters, when the second is taken back.
TEST_F(LookaheadOrderLimits, AnOrderWithinASingleSegmentKeepsTheLimits) {
  for (const char* feedrate : {"28.3", "29.3"})
    for (const char* single : {"I5121=14", "I5121=15"})
      for (int n = 0; n < 8; ++n)
        for (const char* order : {">", "<", "\\"}) {
          SCOPED_TRACE(single + std::string(order) + feedrate + "+" + std::to_string(n));
          platform::power_up();
          fit({"1000X"});
          ASSERT_EQ(host("I5113=10 I116=100 I117=0.1 I5120=80"), "");
          ASSERT_EQ(host("&1DEFINE LOOKAHEAD 200,10"), "");
          store({std::string("F") + feedrate + " TA200 TS0", "X20"});
          double end = 0;
          const auto at_ms = [](double t, double ms) { return t >= ms && t < ms + kTickMs; };
          const auto found = extremes(1, &end, [&](double t) {
            if (at_ms(t, 400)) { ASSERT_EQ(host("&1\\"), ""); }
            if (at_ms(t, 900)) { ASSERT_EQ(host(single), ""); }
            if (at_ms(t, 901 + 4 * n)) { ASSERT_EQ(host(std::string("&1") + order), ""); }
            if (at_ms(t, 1800)) { ASSERT_EQ(host("&1>"), ""); }
          });
          EXPECT_LE(found[0].acceleration, 0.1 * 1.02);
          EXPECT_EQ(motors[0].trajectory, 20000 * 3072LL);
        }
}

// A path that is beyond the limits itself, v^2 / R = 1.6 counts a ms^2: what is lost and won along it is 0.5 of each
// motor, and it comes back to the speed of the program.
TEST_F(LookaheadOrderLimits, OrdersOnAPathBeyondTheLimits) {
  fit({"1000X", "1000Y"});
  ASSERT_EQ(host("I5113=10 I116=50 I117=0.5 I216=50 I217=0.5 I5120=1"), "");
  ASSERT_EQ(host("&1DEFINE LOOKAHEAD 100,10"), "");
  store({"INC F40 TA100 TS0", "CIRCLE1 X0 Y0 I1 J0", "X0 Y0 I1 J0", "X0 Y0 I1 J0", "X0 Y0 I1 J0"});
  double end = 0, stood = 0, fastest = 0, asked = 0, x = at(1), y = at(2);
  const auto found = extremes(2, &end, [&](double t) {
    if (asked == 0 && t >= 300) {
      ASSERT_EQ(host("&1\\"), "");
      asked = t;
    }
    if (asked != 0 && stood == 0 && !cs().active) {
      stood = t;
      ASSERT_EQ(host("&1>"), "");
    }
    if (stood != 0) fastest = std::max(fastest, std::hypot(at(1) - x, at(2) - y) / kTickMs);
    x = at(1), y = at(2);
  });
  EXPECT_GE(stood - asked, 40 / (0.5 * std::sqrt(2)));
  EXPECT_LE(stood - asked, 40 / 0.5 + 35) << "at a segment that begins 12 ms later, a quarter of one more";
  EXPECT_NEAR(fastest, 40 * (1 - 40 * 40 * 10 * 10 / 6e6), 0.1) << "on the spline: motion:7.1/4";
  for (const auto& motor : found) EXPECT_LE(motor.acceleration, (1.6 + 0.5) * 1.02);
  EXPECT_EQ(motors[0].trajectory, 0);
  EXPECT_EQ(motors[1].trajectory, 0);
}

}  // namespace
