// Lookahead (motion:7.3, motion:7.4): what is executed keeps the limits, and the path.
#include "testbench/unit/firmware_paths/extremes_of_motors.h"
#include "testbench/unit/firmware_platform/fake_tasks.h"

extern "C" {
#include "firmware/motion/lookahead_state.h"
}

namespace {

using namespace moving_motors;

class Lookahead : public ExtremesOfMotors {};

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

// Ixx16, Ixx17 of 0 or less are no limits.
TEST_F(Lookahead, WhatIsNotAboveZeroIsNoLimit) {
  for (const char* limits : {"I116=0 I117=0", "I116=-50 I117=0", "I116=0 I117=-1", "I116=-50 I117=-1"}) {
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host(std::string("I5113=5 I5120=40 ") + limits), "");
    ASSERT_EQ(host("&1DEFINE LOOKAHEAD 60,10"), "");
    store({"TM100 TA20 TS0", "X10"});
    double end = 0;
    const auto found = extremes(1, &end);
    EXPECT_EQ(motors[0].trajectory, 10000 * 3072LL);
    EXPECT_NEAR(end, 120 + 10, kTickMs) << limits;
    EXPECT_NEAR(found[0].velocity, 100, 0.1) << limits;
  }
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

// A motor that comes to its velocity within a segment: that is not reckoned in the grain of its acceleration.
TEST_F(Lookahead, VelocityIsLimitedWhateverTheAccelerationIs) {
  for (const char* acceleration : {"1000", "1000000"})
    for (const double velocity : {1.0, 4.0, 7.0}) {
      SCOPED_TRACE(std::string(acceleration) + " " + std::to_string(velocity));
      platform::power_up();
      fit({"1000X"});
      ASSERT_EQ(host("I5113=10 I5120=40 I116=" + std::to_string(velocity)), "");
      ASSERT_EQ(host("I117=" + std::string(acceleration)), "");
      ASSERT_EQ(host("&1DEFINE LOOKAHEAD 60,10"), "");
      store({"F40 TA10 TS0", "X2", "X0"});
      double end = 0;
      const auto found = extremes(1, &end);
      EXPECT_LE(found[0].velocity, 1.001 * velocity + 2 / kUnit / kTickMs) << "two units of position";
      EXPECT_GE(found[0].velocity, 0.999 * velocity - 2 / kUnit / kTickMs);
      EXPECT_EQ(motors[0].trajectory, 0);
    }
}

// motion:7.4/1: a velocity of 7,000 times what a segment adds to it; 8,192 are the range.
TEST_F(Lookahead, VelocityIsLimitedThoughItIsGainedInThousandsOfSegments) {
  fit({"1000X"});
  ASSERT_EQ(host("I5113=1 I5120=4300 I116=7 I117=0.001"), "");
  ASSERT_EQ(host("DELETE GATHER"), "");
  ASSERT_EQ(host("&1DEFINE LOOKAHEAD 4350,0"), "");
  store({"F8 TA10 TS0", "X60"});
  double end = 0;
  const auto found = extremes(1, &end);
  EXPECT_LE(found[0].velocity, 1.001 * 7 + 2 / kUnit / kTickMs);
  EXPECT_GE(found[0].velocity, 6.9) << "7^2 / 0.001 are 49,000 counts";
  EXPECT_LE(found[0].acceleration, 0.001 * 1.02 + 4 / kUnit / (64 * kTickMs * kTickMs));
  EXPECT_EQ(motors[0].trajectory, 60000 * 3072LL);
}

// An abort forgets what is being worked out, in the middle of it; what comes then has all of its limits.
TEST_F(Lookahead, AbortsLeaveTheLimitsAsTheyAre) {
  fit({"1000X", "1000Y"});
  ASSERT_EQ(host("I5113=5 I5120=40 I116=50 I117=1 I216=50 I217=0.5"), "");
  ASSERT_EQ(host("&1DEFINE LOOKAHEAD 60,10"), "");
  store({"F40 TA10 TS0", "X1", "Y1", "X0", "Y0"});
  const double before = run();
  for (unsigned n = 0; n < 300; ++n) {
    ASSERT_EQ(host("&1B1R"), "");
    fake_hal_slices_leave(true);
    looks[0].sweeping = false;  // that of the last round
    for (unsigned slice = 0; slice < 10000 && !looks[0].sweeping; ++slice) platform::real_time();
    ASSERT_TRUE(looks[0].sweeping);
    for (unsigned slice = 0; slice < n % 20; ++slice) platform::real_time();
    ASSERT_EQ(host("&1A"), "");
    fake_hal_slices_leave(false);
    platform::servo_ticks(10);
    ASSERT_FALSE(run_is_running(0));
  }
  EXPECT_EQ(motors[0].trajectory, 0);
  EXPECT_EQ(run(), before);
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

// A segment at a time by Isx21: 14 and 15 are shown as 10 and 11, in bits 11 to 8 of word 3 too, each stops at the next
// knot.
TEST_F(Lookahead, SingleSegments) {
  fit({"1000X"});
  ASSERT_EQ(host("I5113=10 I5120=20 I116=50 I117=1"), "");
  ASSERT_EQ(host("&1DEFINE LOOKAHEAD 60,10"), "");
  store({"TM300 TA50 TS0", "X10"});
  ASSERT_EQ(host("&1B1R"), "");
  const auto shown = [] { return std::stoul(host("??").substr(12, 6), nullptr, 16) >> 8 & 0xF; };
  platform::servo_ticks(400);
  EXPECT_EQ(host("I5121"), "2");
  EXPECT_EQ(shown(), 2u);
  ASSERT_EQ(host("I5121=4"), "");
  platform::servo_ticks(400);
  EXPECT_EQ(host("I5121"), "0");
  EXPECT_EQ(shown(), 0u);
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
    EXPECT_EQ(shown(), 10u);
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
    EXPECT_EQ(shown(), 11u);
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

// motion:7.5/1: at the first quarter of a segment that is far enough. 10 counts/ms, segments of 200 counts about knots
// at 200 k - 100: a stop takes 5, 83, 125, 179 counts.
TEST_F(Lookahead, StopsAreAtQuarters) {
  const std::pair<const char*, int> cases[] = {{"10", 1}, {"0.6", 2}, {"0.4", 3}, {"0.28", 4}};
  for (const auto& [acceleration, quarters] : cases) {
    SCOPED_TRACE(acceleration);
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host(std::string("I5113=20 I5120=20 I116=50 I117=") + acceleration), "");
    ASSERT_EQ(host("&1DEFINE LOOKAHEAD 60,10"), "");
    store({"TM1000 TA20 TS0", "X10"});
    ASSERT_EQ(host("&1B1R"), "");
    platform::servo_ticks(ticks_of(500));
    const double from = at(1);
    ASSERT_EQ(host("&1\\"), "");
    platform::servo_ticks(ticks_of(150));
    const double x = at(1), last = x - 50 * quarters;  // the knot before
    EXPECT_NEAR(std::remainder(last + 100, 200), 0, 0.01) << x;
    EXPECT_GE(last, from + 10 * 12 - 10) << "12 ms are left as they were";
    EXPECT_LE(last, from + 10 * 12 + 200 + 10) << "and no more than a segment";
    ASSERT_EQ(host("&1>"), "");
    platform::servo_ticks(ticks_of(1000));
    EXPECT_EQ(motors[0].trajectory, 10000 * 3072);
  }
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

// `<` runs back to the oldest point, assignments are made once; after a jog it wants the motor back.
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
    ASSERT_EQ(host(std::string("I5113=5 I116=1 I117=0.001 I5195=200000 I5120=") + isx20), "");
    ASSERT_EQ(host("&1DEFINE LOOKAHEAD 300,10"), "");
    store({"TM200 TA20 TS0", "X5", "X10"});
    double end = 0;
    const auto found = extremes(1, &end);
    EXPECT_NEAR(end, 200 + 200 + 20 + 10, kTickMs);
    EXPECT_NEAR(found[0].velocity, 25, 0.1);
    ASSERT_EQ(host("I116=50 I117=1 &1B1R"), "");
    platform::servo_ticks(400);
    ASSERT_EQ(host("&1<"), "");
    platform::servo_ticks(3000);
    // Back from 10000 by 25 counts a ms from half of TA and Isx13 on, and half of that while the time base runs down by
    // Isx95 a tick.
    const double stopped = 10000 - 25 * (400 * kTickMs - 10 - 5 + 3713991 / 200000.0 / 2 * kTickMs);
    if (isx20[0] == '1')
      EXPECT_EQ(motors[0].trajectory, 10000 * 3072) << "back where it began";
    else
      EXPECT_NEAR(at(1), stopped, 60) << "as H, on its way from 10000 to 5000";
  }
}

// Whether another line comes is not known at the end of a rotary buffer: the last one is its end all the same, in time
// for one stop there and none on the way.
TEST_F(Lookahead, ARotaryBufferThatRunsEmptyStopsOnceAtItsEnd) {
  fit({"X"});
  ASSERT_EQ(host("I5113=5 I5120=20 I116=24 I117=1"), "");
  ASSERT_EQ(host("&1DEFINE LOOKAHEAD 40,0 DEFINE ROTARY 100 B0 OPEN ROTARY"), "");
  ASSERT_EQ(host("INC LINEAR TA4 TS0 TM5"), "");
  for (int i = 0; i < 40; ++i) ASSERT_EQ(host("X100"), "");
  ASSERT_EQ(host("&1R"), "");
  std::vector<double> slow;  // places of a velocity below 5, from 300 counts on
  double before = 0;
  for (int tick = 0; tick < 1000; ++tick) {
    platform::servo_ticks(1);
    const double x = at(1);
    if (x > 300 && x < 4000 && (x - before) / kTickMs < 5) slow.push_back(x);
    before = x;
  }
  EXPECT_EQ(motors[0].trajectory, 4000 * 3072LL);
  ASSERT_FALSE(slow.empty());
  EXPECT_GT(slow.front(), 4000 - 5 * 5 / 2.0 - 10) << "5 counts/ms at 1 count/ms^2 are 12.5 counts";
}

// Lines that come again while the motors still run out are calculated meanwhile, not when these stand: behind the stop
// that could not be helped the path is one.
TEST_F(Lookahead, LinesThatComeWhileAPathRunsOutNeedOneStop) {
  unsigned stopped = 0;
  for (unsigned behind = 92; behind < 220; behind += 8) {
    SCOPED_TRACE(behind);
    platform::power_up();
    fit({"X"});
    ASSERT_EQ(host("I5113=5 I5120=8 I116=24 I117=0.5"), "");
    ASSERT_EQ(host("&1DEFINE LOOKAHEAD 40,0 DEFINE ROTARY 100 B0 OPEN ROTARY"), "");
    ASSERT_EQ(host("INC LINEAR TA4 TS0 TM5"), "");
    for (int i = 0; i < 40; ++i) ASSERT_EQ(host("X100"), "");
    ASSERT_EQ(host("&1R"), "");
    while (host("PR") != "0") platform::servo_ticks(1);
    platform::servo_ticks(behind);
    unsigned stops = 0;
    double before = at(1), speed = 0;
    for (unsigned tick = 0; tick < 1500; ++tick) {
      if (tick % 3 == 0 && tick < 60) { ASSERT_EQ(host("X100"), ""); }
      platform::servo_ticks(1);
      const double now = (at(1) - before) / kTickMs;
      before = at(1);
      stops += speed >= 1 && now < 1 && before < 5900;
      speed = now;
    }
    EXPECT_EQ(motors[0].trajectory, 6000 * 3072LL);
    EXPECT_LE(stops, 1u);
    stopped += stops;
  }
  EXPECT_GE(stopped, 16u) << "lines have come too early to show anything";
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

// motion:7.5/6. Ixx24 bit 15: it stops on the path before what lies beyond, goes on into it a segment at a time, and
// back as ever. Y is half as fast: where it is tells whether the path is the same.
TEST_F(Lookahead, TheLimitOfADesiredPositionStopsOnThePath) {
  fit({"1000X", "500X"});
  ASSERT_EQ(host("I5113=5 I5120=40 I116=50 I117=1 I216=50 I217=1 I113=50000 I141=1000 I124=$8001"), "");
  ASSERT_EQ(host("&1DEFINE LOOKAHEAD 600,10"), "");
  store({"F50 TA10 TS0", "X100"});
  ASSERT_EQ(host("&1B1R"), "");
  std::vector<double> x;
  const auto go = [&](unsigned ticks) {
    for (unsigned i = 0; i < ticks; ++i) {
      platform::servo_ticks(1);
      x.push_back(at(1));
      ASSERT_NEAR(at(2), x.back() / 2, 0.01);
      ASSERT_LE(x.back(), 49000);
    }
  };
  go(ticks_of(1300));
  const double stop = at(1);
  EXPECT_GT(stop, 49000 - 3 * 250) << "three segments of 5 ms at 50 counts/ms";
  EXPECT_EQ(host("I5121"), "0");
  EXPECT_EQ(host("??").substr(12, 6).back() & 2, 2) << "bit 1 of word 3";
  for (std::size_t n = 2; n < x.size(); ++n)
    ASSERT_LE(std::abs(x[n] - 2 * x[n - 1] + x[n - 2]), 1.02 * kTickMs * kTickMs + 4 / kUnit);
  ASSERT_EQ(host("&1<"), "");
  go(ticks_of(600));
  EXPECT_LT(at(1), stop - 5000);
  ASSERT_EQ(host("&1>"), "");
  go(ticks_of(1500));
  EXPECT_EQ(at(1), stop) << "there again";
}

TEST_F(Lookahead, BeyondTheLimitASegmentAtATime) {
  fit({"1000X", "1000Y"});
  ASSERT_EQ(host("I5113=5 I5120=40 I116=50 I117=1 I216=50 I217=1 I113=50000 I124=$8001"), "");
  ASSERT_EQ(host("&1DEFINE LOOKAHEAD 600,10"), "");
  store({"F50 TA10 TS0 FRAX(X)", "X100 Y100"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(ticks_of(1300));
  const double stop = at(2);
  EXPECT_LT(stop, 50000);
  for (int i = 1; i <= 4; ++i) {
    ASSERT_EQ(host(i % 2 == 0 ? "&1R" : "&1>"), "");
    platform::servo_ticks(ticks_of(200));
    EXPECT_NEAR(at(2), stop + 250 * i, 0.01) << "5 ms at 50 counts/ms";
    EXPECT_LE(at(1), 50000);
    EXPECT_EQ(host("??").substr(12, 6).back() & 2, 2);
  }
  EXPECT_EQ(motors[0].trajectory, 50000 * 3072) << "the target is held at the limit";
  EXPECT_TRUE(run_is_running(0));
}

// Bit 14: on, with that motor at its limit.
TEST_F(Lookahead, AtTheLimitOfADesiredPositionItGoesOn) {
  fit({"1000X", "1000Y"});
  ASSERT_EQ(host("I5113=5 I5120=40 I116=50 I117=1 I216=50 I217=1 I113=50000 I114=-100 I141=40 I124=$C001"), "");
  ASSERT_EQ(host("&1DEFINE LOOKAHEAD 600,10"), "");
  store({"F50 TA10 TS0", "X100 Y80", "X-2 Y20"});
  double end = 0;
  const auto found = extremes(2, &end);
  EXPECT_LE(found[0].acceleration, 1.02);
  EXPECT_EQ(motors[0].trajectory, -60 * 3072) << "Ixx14 + Ixx41";
  EXPECT_EQ(motors[1].trajectory, 20000 * 3072);
}

unsigned word3() { return static_cast<unsigned>(std::stoul(host("??").substr(12, 6), nullptr, 16)); }

// motion:7.3/4. Assignments wait in the slots of the buffer: what has none is lost, and bit 19 of word 3 says so.
TEST_F(Lookahead, AssignmentsWaitInTheSlotsOfTheBuffer) {
  for (const unsigned slots : {0u, 3u, 40u}) {
    SCOPED_TRACE(slots);
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host("I5113=5 I5120=100 I116=50 I117=1 M1..40->* M1..40=0"), "");
    const unsigned open = static_cast<unsigned>(std::stoul(host("SIZE")));
    ASSERT_EQ(host("&1DEFINE LOOKAHEAD 120," + std::to_string(slots)), "");
    EXPECT_EQ(open - static_cast<unsigned>(std::stoul(host("SIZE"))), 120 * 6 + 2 * slots);
    Lines lines = {"TM10 TA5 TS0 DWELL100"};
    for (int i = 1; i <= 40; ++i) lines.push_back("M" + std::to_string(i) + "==1 X" + std::to_string(i * 0.1));
    store(lines);
    bool waited = false;
    unsigned half = 99;
    run([&](double) {
      waited |= (word3() >> 20 & 1) != 0;
      if (half == 99 && at(1) > 2000) {
        half = 0;
        for (int i = 1; i <= 40; ++i) half += m_variable_read(i) != 0;
      }
    });
    platform::servo_ticks(5);
    unsigned made = 0;
    for (int i = 1; i <= 40; ++i) made += m_variable_read(i) != 0;
    if (slots == 40) {
      EXPECT_EQ(made, 40u);
      EXPECT_NEAR(half, 21, 1);
    } else {
      EXPECT_LT(made, 30u);
      EXPECT_GE(made, slots);
    }
    EXPECT_EQ(word3() >> 19 & 1, slots == 40 ? 0u : 1u);
    EXPECT_EQ(waited, slots != 0);
    EXPECT_EQ(word3() >> 20 & 1, 0u);
    store({"TM10 X0"});
    run();
    EXPECT_EQ(word3() >> 19 & 1, 0u) << "of the last start";
  }
}

// firmware:4.2/12. Assignments of moves that Q leaves for the next start wait in the buffer: it stays until A.
TEST_F(Lookahead, ABufferInWhichAssignmentsWaitStays) {
  for (const bool aborts : {false, true}) {
    SCOPED_TRACE(aborts);
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host("I5113=5 I5120=20 I116=50 I117=1 M1..4->* M1..4=0"), "");
    ASSERT_EQ(host("DELETE GATHER"), "");
    ASSERT_EQ(host("&1DEFINE LOOKAHEAD 60,10"), "");
    store({"TM200 TA20 TS0", "M1==1 X1", "M2==1 X2", "M3==1 X3", "M4==1"});
    ASSERT_EQ(host("&1B1R"), "");
    platform::servo_ticks(ticks_of(150));
    ASSERT_EQ(host("&1Q"), "");
    platform::servo_ticks(ticks_of(1000));
    ASSERT_FALSE(run_is_running(0));
    ASSERT_EQ(word3() >> 20 & 1, 1u);
    for (const char* command : {"&1DELETE LOOKAHEAD", "&1DEFINE LOOKAHEAD 60,10", "&2DELETE ALL", "DELETE ALL TEMPS"})
      EXPECT_EQ(host(command), "ERR001") << command;
    if (aborts) {
      ASSERT_EQ(host("&1A"), "");
      platform::servo_ticks(10);
      EXPECT_EQ(host("&1DELETE LOOKAHEAD"), "");
      continue;
    }
    ASSERT_EQ(host("&1R"), "");
    platform::servo_ticks(ticks_of(1500));
    for (int m = 1; m <= 4; ++m) EXPECT_EQ(m_variable_read(m), 1) << m;
    EXPECT_EQ(host("&1DELETE LOOKAHEAD"), "");
  }
}

// Bits 21 to 23 of word 3 (firmware:5.6): it stands at the oldest segment, goes backwards, has written over segments.
TEST_F(Lookahead, StatusOfTheBuffer) {
  fit({"1000X"});
  ASSERT_EQ(host("I5113=5 I5120=20 I116=50 I117=1"), "");
  ASSERT_EQ(host("&1DEFINE LOOKAHEAD 60,0"), "");
  store({"TM1000 TA20 TS0", "X20"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(ticks_of(100));
  EXPECT_EQ(word3() >> 21, 0u);
  ASSERT_EQ(host("&1<"), "");
  platform::servo_ticks(ticks_of(60));
  EXPECT_EQ(word3() >> 21, 2u) << "backwards";
  platform::servo_ticks(ticks_of(500));
  EXPECT_EQ(word3() >> 21, 3u) << "at the oldest";
  ASSERT_EQ(host("&1>"), "");
  platform::servo_ticks(ticks_of(700));
  EXPECT_EQ(word3() >> 21, 4u) << "60 segments of 5 ms are written over";
  ASSERT_EQ(host("&1<"), "");
  platform::servo_ticks(ticks_of(800));
  EXPECT_EQ(word3() >> 21, 7u);
  EXPECT_GT(at(1), 1000) << "what is written over is not come back to";
  ASSERT_EQ(host("&1>"), "");
  platform::servo_ticks(ticks_of(2500));
  EXPECT_EQ(motors[0].trajectory, 20000 * 3072);
  EXPECT_EQ(word3() >> 21, 0u);
}

}  // namespace
