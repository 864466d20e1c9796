// Isx15, Isx16: how fast a path is gone through (motion:7.1/6).
#include "testbench/unit/firmware_program/moving_motors.h"

namespace {

using namespace moving_motors;

class SegmentOverride : public MovingMotors {};

// Isx15: the path is gone through at (Isx15 + 1) times its speed.
TEST_F(SegmentOverride, IsOfTheSpeed) {
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

// Isx16: so much of it a segment, both ways; 0, and 2 or more, at once.
TEST_F(SegmentOverride, GoesByIsx16ASegment) {
  const std::uint32_t one = SEGMENT_OVERRIDE_ONE;
  const struct {
    const char *isx15, *isx16;
    double present, next;
  } cases[] = {{"0.5", "0.25", 1, 1.25},  {"0.5", "0.25", 1.25, 1.5}, {"0.5", "0.25", 1.375, 1.5}, {"0.5", "0", 1, 1.5},
               {"-0.5", "0.25", 1, 0.75}, {"-0.5", "0.25", 0.6, 0.5}, {"-1", "1.5", 2, 0.5},       {"1", "2", 0, 2},
               {"-1", "7", 2, 0},         {"1", "-1", 0, 2},          {"-3", "1", 0.5, 0},         {"3", "1.5", 0, 1.5},
               {"0", "0.5", 2, 1.5},      {"0", "0.5", 0, 0.5},       {"0", "0.5", 1, 1}};
  for (const auto& c : cases) {
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host("I5113=5"), "");
    store({"TM1000 TA20 TS0", "X3"});
    ASSERT_EQ(host("&1B1R"), "");
    platform::servo_ticks(60);
    ASSERT_EQ(host(std::string("I5115=") + c.isx15 + " I5116=" + c.isx16), "");
    cs().segment_override = static_cast<std::uint32_t>(c.present * one);
    const std::uint32_t before = cs().segment_override;
    for (int i = 0; i < 100 && cs().segment_override == before; ++i) platform::servo_ticks(1);
    EXPECT_EQ(cs().segment_override, static_cast<std::uint32_t>(c.next * one)) << c.isx15 << " by " << c.isx16;
  }
}

// Neither the override nor the state of a path outlasts a reset, saved or not; Isx16 does.
TEST_F(SegmentOverride, AndStateAreNotSaved) {
  ASSERT_EQ(host("I5115=-0.5 I5116=0.25 I5120=40 I5121=4 I6615=0.5 SAVE"), "");
  EXPECT_EQ(host("I5115 I5121"), "-0.5|4") << "no path has taken the order";
  platform::reset();
  EXPECT_EQ(host("I5115 I5116 I5120 I5121 I6615"), "0|0.25|40|0|0");
}

// motion:7.1/6, motion:7.4 on the way: slower, faster than the program, not at all, and on. Limits and path are as
// ever: Y goes a half of X's way.
TEST_F(SegmentOverride, OnTheWayInLookahead) {
  fit({"1000X", "1000Y"});
  ASSERT_EQ(host("I5113=5 I5120=40 I116=50 I117=0.5 I216=50 I217=0.5"), "");
  ASSERT_EQ(host("&1DEFINE LOOKAHEAD 60,10"), "");
  store({"F40 TA10 TS0", "X60 Y30"});
  ASSERT_EQ(host("&1B1R"), "");
  std::vector<double> x;
  const auto go_on = [&](double ms) {
    for (unsigned n = ticks_of(ms); n > 0; --n) {
      platform::servo_ticks(1);
      x.push_back(at(1));
      ASSERT_NEAR(at(2), at(1) / 2, 0.01);
    }
  };
  const auto speed = [&] { return (x[x.size() - 1] - x[x.size() - 11]) / (10 * kTickMs); };
  const double full = 40 * 2 / std::sqrt(5.0);  // counts/ms of X
  // 60 segments of the buffer and of the servo task are 300 ms, longer where they are stretched
  for (const auto& [isx15, expected] : {std::pair{"0", full}, {"-0.5", full / 2}, {"0.25", full * 1.25}, {"-1", 0.0}}) {
    ASSERT_EQ(host(std::string("I5115=") + isx15), "");
    go_on(500);
    EXPECT_NEAR(speed(), expected, 0.01 * full) << isx15;
  }
  const double stood = at(1);
  go_on(500);
  EXPECT_EQ(at(1), stood);
  EXPECT_TRUE(run_is_running(0));
  ASSERT_EQ(host("I5115=0"), "");
  go_on(1500);
  EXPECT_EQ(motors[0].trajectory, 60000 * 3072LL);
  EXPECT_EQ(motors[1].trajectory, 30000 * 3072LL);
  EXPECT_EQ(cs().error, RUN_TIME_NONE);
  EXPECT_FALSE(run_is_running(0));
  double fastest = 0, sharpest = 0;
  constexpr unsigned kSpan = 8;
  for (std::size_t n = 2 * kSpan; n < x.size(); ++n) {
    const double span = kSpan * kTickMs;
    fastest = std::max(fastest, std::abs(x[n] - x[n - 1]) / kTickMs);
    sharpest = std::max(sharpest, std::abs(x[n] - 2 * x[n - kSpan] + x[n - 2 * kSpan]) / (span * span));
  }
  EXPECT_LE(fastest, 50 * 1.005);
  EXPECT_LE(sharpest, 0.5 * 1.02);
}

// Isx16: from 1 on by 0.05 a segment. Ten segments of 1.05 to 1.5 are 63.75 ms of 120, then 8 of 7.5; of 0.95 to 0.5
// they are 36.25, then 34 of 2.5.
TEST_F(SegmentOverride, IsSlewed) {
  for (const auto& [isx15, segments] : {std::pair{"0.5", 18}, {"-0.5", 44}}) {
    platform::power_up();
    fit({"1000X"});
    store({"TM100 TA20 TS0 INC", "X3"});
    ASSERT_EQ(host(std::string("I5113=5 I5116=0.05 I5115=") + isx15), "");
    EXPECT_NEAR(run(), 5 * (segments + 2), kTickMs) << isx15;
  }
}

// What it has come to is where the next sequence begins, of the same program or another, behind an abort too; a reset
// alone makes it 1. From 1.5 twenty segments of 1.45 to 0.5 are 97.5 ms of 120, then 9 of 2.5; at 0.5 there are 48, a
// DWELL behind the first.
TEST_F(SegmentOverride, GoesOnFromSequenceToSequence) {
  fit({"1000X"});
  store({"TM100 TA20 TS0 INC", "X3"});
  ASSERT_EQ(host("I5113=5 I5116=0.05 I5115=0.5"), "");
  EXPECT_NEAR(run(), 5 * (18 + 2), kTickMs);
  ASSERT_EQ(host("I5115=-0.5"), "");
  EXPECT_NEAR(run(), 5 * (29 + 2), kTickMs);
  store({"X3", "DWELL50", "X3"}, 2);
  const double both = run([](double) {}, "&1B2R");
  EXPECT_GE(both, 2 * 5 * (48 + 2) + 50);
  EXPECT_LT(both, 2 * 5 * (48 + 2) + 50 + 20) << "what lies between them is not by segments";

  ASSERT_EQ(host("I5115=-1 I5116=0 &1B1R"), "");
  platform::servo_ticks(ticks_of(100));
  const std::int64_t stands = motors[0].trajectory;
  ASSERT_EQ(host("&1A I5116=0.01"), "");
  platform::servo_ticks(ticks_of(100));
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(ticks_of(1000));
  EXPECT_EQ(motors[0].trajectory, stands) << "from 0 to 0";
  EXPECT_TRUE(run_is_running(0));

  platform::reset();
  fit({"1000X"});
  store({"TM100 TA20 TS0 INC", "X3"});
  ASSERT_EQ(host("I5113=5 I5116=0.05 I5115=0.5"), "");
  EXPECT_NEAR(run(), 5 * (18 + 2), kTickMs);
}

}  // namespace
