// Lookahead (motion:7.3, motion:7.4): what is executed keeps the limits, and the path.
#include "testbench/unit/firmware_program/moving_motors.h"

namespace {

using namespace moving_motors;

class Lookahead : public MovingMotors {
 protected:
  // Largest of the first and second differences (counts a ms, a ms^2) of a motor at any interrupt.
  struct Extremes {
    double velocity = 0, acceleration = 0;
  };
  static std::vector<Extremes> extremes(unsigned count, double* end, const std::string& start = "&1B1R") {
    std::vector<Extremes> found(count);
    std::vector<std::vector<double>> samples(count);
    constexpr unsigned kSpan = 8;  // interrupts
    *end = run(
        [&](double) {
          for (unsigned i = 0; i < count; ++i) {
            auto& s = samples[i];
            s.push_back(at(i + 1));
            const std::size_t n = s.size();
            if (n < 2 * kSpan + 1) continue;
            const double span = kSpan * kTickMs, v1 = (s[n - 1] - s[n - 1 - kSpan]) / span;
            const double v0 = (s[n - 1 - kSpan] - s[n - 1 - 2 * kSpan]) / span;
            found[i].velocity = std::max(found[i].velocity, std::abs(s[n - 1] - s[n - 2]) / kTickMs);
            found[i].acceleration = std::max(found[i].acceleration, std::abs(v1 - v0) / span);
          }
        },
        start);
    return found;
  }
};

// X 0 to 100 000 counts at 100 counts/ms asked for, 50 allowed; 1 count/ms^2: 50 ms up and down.
TEST_F(Lookahead, ALineIsLimited) {
  fit({"1000X"});
  ASSERT_EQ(host("I5113=5 I5120=40 I116=50 I117=1"), "");
  ASSERT_EQ(host("&1DEFINE LOOKAHEAD 60,10"), "");
  store({"F100 TA10 TS0", "X100"});
  double end = 0;
  const auto found = extremes(1, &end);
  EXPECT_EQ(motors[0].trajectory, 100000 * 3072LL);
  EXPECT_LE(found[0].velocity, 50 * 1.005);
  EXPECT_LE(found[0].acceleration, 1.02);
  EXPECT_GE(found[0].velocity, 49.5);
  EXPECT_LE(end, 1.1 * (2000 + 50));
}

TEST_F(Lookahead, CornersAreSlowedDown) {
  fit({"1000X", "1000Y"});
  ASSERT_EQ(host("I5113=5 I5120=40 I116=50 I117=1 I216=50 I217=0.5"), "");
  ASSERT_EQ(host("&1DEFINE LOOKAHEAD 60,10"), "");
  store({"F40 TA10 TS0", "X20", "Y20", "X0", "Y0", "X10 Y10", "CIRCLE1 X10 Y10 I5 J0"});
  double end = 0;
  const auto found = extremes(2, &end);
  EXPECT_EQ(motors[0].trajectory, 10000 * 3072LL);
  EXPECT_EQ(motors[1].trajectory, 10000 * 3072LL);
  EXPECT_LE(found[0].acceleration, 1.02);
  EXPECT_LE(found[1].acceleration, 0.51);
  EXPECT_LE(found[0].velocity, 40 * 1.005);
  EXPECT_GT(found[0].velocity, 39.5);
  RecordProperty("ms", static_cast<int>(end));
}

// LA-5: 400 counts/ms, 1 count/ms^2, 5 ms: StopTime / 2 = 200 ms are 40 segments, 4/3 of them 54. Half as many hold the
// limits too and are slower.
TEST_F(Lookahead, SizingOfTheExample) {
  double times[2], fastest[2];
  for (int i = 0; i < 2; ++i) {
    platform::power_up();
    fit({"1000X", "1000Y"});
    ASSERT_EQ(host("I5113=5 I116=400 I117=1 I216=400 I217=1 I5120=" + std::string(i == 0 ? "54" : "27")), "");
    ASSERT_EQ(host("&1DEFINE LOOKAHEAD 80,0"), "");
    store({"F400 TA10 TS0", "X300", "Y300"});
    const auto found = extremes(2, &times[i]);
    for (const auto& motor : found) EXPECT_LE(motor.acceleration, 1.02);
    fastest[i] = found[0].velocity;
    EXPECT_LE(fastest[i], 400 * 1.005);
    EXPECT_EQ(motors[0].trajectory, 300000 * 3072LL);
    EXPECT_EQ(motors[1].trajectory, 300000 * 3072LL);
  }
  EXPECT_GT(fastest[0], 399);
  // Each side: 300,000 counts at 400 and half of the change of speed at each end, at the corner both together.
  EXPECT_LE(times[0], 1.1 * 2 * (750 + 400));
  EXPECT_GT(times[1], times[0] + 100);
  EXPECT_LT(fastest[1], 350) << "27 segments of 5 ms stop from sqrt(2 x 27 x 5 x v)";
}

// A segment at a time by Isx21: 14 and 15 are shown as 10 and 11, each stops at the next knot.
TEST_F(Lookahead, SingleSegments) {
  fit({"1000X"});
  ASSERT_EQ(host("I5113=10 I5120=20 I116=50 I117=1"), "");
  ASSERT_EQ(host("&1DEFINE LOOKAHEAD 60,10"), "");
  store({"TM300 TA50 TS0", "X10"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(400);
  EXPECT_EQ(host("I5121"), "2");
  ASSERT_EQ(host("I5121=4"), "");
  platform::servo_ticks(400);
  EXPECT_EQ(host("I5121"), "0");
  const auto stands = [] {
    const std::int64_t before = motors[0].trajectory;
    platform::servo_ticks(50);
    return motors[0].trajectory == before;
  };
  ASSERT_TRUE(stands());
  std::vector<double> places = {at(1)};
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(host("I5121=14"), "");
    platform::servo_ticks(300);
    EXPECT_EQ(host("I5121"), "10");
    ASSERT_TRUE(stands());
    places.push_back(at(1));
  }
  // 33.3 counts/ms over 10 ms: knots are 333.3 counts apart, the first one is the rest of the segment
  EXPECT_GT(places[1], places[0]);
  EXPECT_LE(places[1] - places[0], 334);
  EXPECT_NEAR(places[2] - places[1], 1000.0 / 3, 0.01);
  EXPECT_NEAR(places[3] - places[2], 1000.0 / 3, 0.01);
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(host("I5121=15"), "");
    platform::servo_ticks(300);
    EXPECT_EQ(host("I5121"), "11");
    ASSERT_TRUE(stands());
  }
  EXPECT_NEAR(at(1), places[1], 0.01);
  ASSERT_EQ(host("&1>"), "");
  platform::servo_ticks(3000);
  EXPECT_EQ(motors[0].trajectory, 10000 * 3072);
  EXPECT_FALSE(run_is_running(0));
}

// The commands by Isx21: 4 stops on the path, 7 goes back, 6 forwards.
TEST_F(Lookahead, OrdersByIsx21) {
  fit({"1000X"});
  ASSERT_EQ(host("I5113=5 I5120=40 I116=50 I117=1"), "");
  ASSERT_EQ(host("&1DEFINE LOOKAHEAD 300,10"), "");
  store({"TM200 TA20 TS0", "X5", "X10"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(500);
  ASSERT_EQ(host("I5121=4"), "");
  platform::servo_ticks(500);
  EXPECT_EQ(host("I5121"), "0");
  const std::int64_t stopped = motors[0].trajectory;
  ASSERT_EQ(host("I5121=7"), "");
  platform::servo_ticks(50);
  EXPECT_EQ(host("I5121"), "3");
  EXPECT_LT(motors[0].trajectory, stopped);
  platform::servo_ticks(3000);
  EXPECT_EQ(motors[0].trajectory, 0) << "where the sequence began";
  ASSERT_EQ(host("I5121=6"), "");
  platform::servo_ticks(50);
  EXPECT_EQ(host("I5121"), "2");
  platform::servo_ticks(3000);
  EXPECT_EQ(motors[0].trajectory, 10000 * 3072);
}

// Isx20 below four is four: what moves is the same.
TEST_F(Lookahead, FewerThanFourSegmentsAreFour) {
  double times[3];
  for (int i = 0; i < 3; ++i) {
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host("I5113=5 I116=50 I117=1 I5120=" + std::to_string(i + 2)), "");
    ASSERT_EQ(host("&1DEFINE LOOKAHEAD 60,10"), "");
    store({"F100 TA10 TS0", "X2"});
    times[i] = run();
    EXPECT_EQ(motors[0].trajectory, 2000 * 3072);
  }
  EXPECT_EQ(times[0], times[2]);
  EXPECT_EQ(times[1], times[2]);
}

// `<` runs back to the oldest point, assignments are made once, PE tells the line; after a jog it wants the motor back.
TEST_F(Lookahead, BackToTheBeginOfTheSequence) {
  fit({"1000X"});
  ASSERT_EQ(host("I5113=5 I5120=40 I116=50 I117=1 M1->* M2->*"), "");
  ASSERT_EQ(host("&1DEFINE LOOKAHEAD 300,10"), "");
  store({"TM200 TA20 TS0 M1=0", "M1==1 X5", "M1==2 X10", "X15"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(900);
  EXPECT_EQ(m_variable_read(1), 2);
  ASSERT_EQ(host("M1=7"), "");
  ASSERT_EQ(host("&1<"), "");
  platform::servo_ticks(3000);
  EXPECT_EQ(motors[0].trajectory, 0);
  EXPECT_EQ(host("I5121"), "0");
  EXPECT_EQ(m_variable_read(1), 7);
  ASSERT_EQ(host("#1J:100"), "");
  platform::servo_ticks(1000);
  EXPECT_EQ(host("&1>"), "ERR017");
  EXPECT_EQ(host("&1R"), "ERR017");
  ASSERT_EQ(host("#1J="), "");
  platform::servo_ticks(1000);
  ASSERT_EQ(host("&1>"), "");
  platform::servo_ticks(5000);
  EXPECT_EQ(motors[0].trajectory, 15000 * 3072);
  EXPECT_EQ(m_variable_read(1), 7) << "forward the first time only";
}

// Isx20 = 1: stored, not limited. Isx20 = 0: not used though there is a buffer.
TEST_F(Lookahead, OffAndStoredOnly) {
  for (const char* isx20 : {"0", "1"}) {
    SCOPED_TRACE(isx20);
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host(std::string("I5113=5 I116=1 I117=0.001 I5120=") + isx20), "");
    ASSERT_EQ(host("&1DEFINE LOOKAHEAD 300,10"), "");
    store({"TM200 TA20 TS0", "X5", "X10"});
    double end = 0;
    const auto found = extremes(1, &end);
    EXPECT_NEAR(end, 200 + 200 + 20 + 10, kTickMs);
    EXPECT_NEAR(found[0].velocity, 25, 0.1);
    ASSERT_EQ(host("&1B1R"), "");
    platform::servo_ticks(400);
    ASSERT_EQ(host("&1<"), "");
    platform::servo_ticks(3000);
    if (isx20[0] == '1')
      EXPECT_EQ(motors[0].trajectory, 10000 * 3072) << "back where it began";
    else
      EXPECT_GT(motors[0].trajectory, 0) << "as H";
  }
}

// A host that stops sending in time: the move ends at rest; a little later it goes on.
TEST_F(Lookahead, AStarvedRotaryBufferEndsItsMovesWithinTheLimits) {
  fit({"1000X"});
  ASSERT_EQ(host("I5113=5 I5120=40 I116=50 I117=1"), "");
  ASSERT_EQ(host("DELETE GATHER"), "");
  ASSERT_EQ(host("&1DEFINE LOOKAHEAD 100,10 DEFINE ROTARY 200 B0 OPEN ROTARY"), "");
  ASSERT_EQ(host("TM100 TA20 TS0 INC"), "");
  ASSERT_EQ(host("R"), "");
  std::vector<std::int64_t> x;
  for (int i = 0; i < 12; ++i) {
    ASSERT_EQ(host("X3"), "");
    for (unsigned tick = 0; tick < (i % 4 == 3 ? 1200u : 200u); ++tick) {
      platform::servo_ticks(1);
      x.push_back(motors[0].trajectory);
    }
  }
  EXPECT_EQ(motors[0].trajectory, 36000 * 3072);
  EXPECT_EQ(cs().error, RUN_TIME_NONE);
  double sharpest = 0, fastest = 0;
  for (std::size_t n = 2; n < x.size(); ++n) {
    sharpest = std::max(sharpest, std::abs(static_cast<double>(x[n] - 2 * x[n - 1] + x[n - 2])));
    fastest = std::max(fastest, std::abs(static_cast<double>(x[n] - x[n - 1])));
  }
  EXPECT_LE(sharpest, 1.02 * kUnit * kTickMs * kTickMs + 4);
  EXPECT_GT(fastest, 25 * kUnit * kTickMs);
}

// Isx15: the path is gone through at (Isx15 + 1) times its speed.
TEST_F(Lookahead, SegmentOverride) {
  fit({"1000X"});
  ASSERT_EQ(host("I5113=5 I5115=-0.5"), "");
  store({"TM100 TA20 TS0", "X3"});
  EXPECT_NEAR(run(), 240 + 10, kTickMs);
  ASSERT_EQ(host("I5115=0.5"), "");
  store({"X0"});
  EXPECT_NEAR(run(), 80 + 10, kTickMs);
  ASSERT_EQ(host("I5115=7"), "");
  store({"X3"});
  EXPECT_NEAR(run(), 60 + 10, kTickMs) << "saturated";
  EXPECT_EQ(motors[0].trajectory, 3000 * 3072);
}

}  // namespace
