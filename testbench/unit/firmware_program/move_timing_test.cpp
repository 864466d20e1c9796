// Time of moves, counted in servo interrupts (firmware:7.5). Expected counts are arithmetic on I10: one servo interrupt
// advances the trajectory by I10 * 2^-23 ms.
#include <cmath>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_program/platform.h"

namespace {

using platform::host;

unsigned ticks_of(double ms) { return static_cast<unsigned>(std::ceil(ms * 8388608.0 / platform::kDefaultI10)); }

class MoveTiming : public FirmwareTest {
 protected:
  void SetUp() override {
    FirmwareTest::SetUp();
    ASSERT_EQ(host("DEF ROT 500 B0 OPEN ROT"), "");
  }
  static void lines(std::initializer_list<const char*> texts) {
    for (const char* text : texts) ASSERT_EQ(host(text), "") << text;
  }
  static coordinate_system& cs() { return coordinate_systems[0]; }
  // Servo interrupts from the one that starts the first move to the one that ends the last.
  static unsigned run() {
    EXPECT_EQ(host("R"), "");
    for (int i = 0; !cs().next_valid; ++i) {
      platform::real_time();
      if (i > 100) return 0;
    }
    platform::servo_ticks(1);
    EXPECT_TRUE(cs().active);
    unsigned ticks = 0;
    while (cs().active || cs().next_valid || rotary_buffers[0].lines != 0) {
      platform::servo_ticks(1);
      if (++ticks > 100000) break;
    }
    return ticks;
  }
};

TEST_F(MoveTiming, TimeSpecifiedMoveTakesTmPlusTa) {
  lines({"TM100 TA40 TS0 X10"});
  EXPECT_EQ(run(), ticks_of(140.0));
  EXPECT_EQ(cs().position[AXIS_X], 10.0);
}

TEST_F(MoveTiming, DefaultsAreTs50AndF1000) {  // Isx88 = 50 -> Ta = 100 ms; Isx89 = 1000 units/s
  lines({"X300"});
  EXPECT_EQ(run(), ticks_of(300.0 + 100.0));
}

TEST_F(MoveTiming, FeedSpecifiedVectorOfTheManual) {  // FRAX(X,Y), X30 Y40 Z10 F100: D = 50, Tm = 0.5 s
  lines({"FRAX(X,Y) TA0 TS20 F100 X30 Y40 Z10"});
  EXPECT_EQ(run(), ticks_of(500.0 + 40.0));
}

TEST_F(MoveTiming, FeedrateOnTheSameLineCounts) {
  lines({"TA10 TS0 X100 F50"});
  EXPECT_EQ(run(), ticks_of(2000.0 + 10.0));
}

TEST_F(MoveTiming, FeedrateIsClippedToIsx98) {
  ASSERT_EQ(host("CLOSE I5198=10 OPEN ROT"), "");
  lines({"TA10 TS0 F100 X5"});
  EXPECT_EQ(run(), ticks_of(500.0 + 10.0));
  platform::power_up();
  ASSERT_EQ(host("I5198=10 DEF ROT 50 B0 OPEN ROT"), "");
  lines({"TA10 TS0 F5 X5"});
  EXPECT_EQ(run(), ticks_of(1000.0 + 10.0)) << "not raised to it";
}

// firmware:7.1/4: F alone is clipped, when it is executed, and Isx89 reads what it is then.
TEST_F(MoveTiming, Isx98ClipsNothingButF) {
  ASSERT_EQ(host("CLOSE I5198=10 I5189=100 OPEN ROT"), "");
  lines({"TA10 TS0 X5"});
  EXPECT_EQ(run(), ticks_of(50.0 + 10.0)) << "a feedrate that stands in Isx89";
  lines({"I5189=50 X10"});
  EXPECT_EQ(run(), ticks_of(100.0 + 10.0)) << "and one that the program writes there";
  lines({"TM50 X15"});
  EXPECT_EQ(run(), ticks_of(50.0 + 10.0)) << "a time";
  EXPECT_EQ(host("I5189"), "50");
  lines({"F100 I5198=5 X20"});
  EXPECT_EQ(run(), ticks_of(500.0 + 10.0)) << "by Isx98 as it was at the F";
  EXPECT_EQ(host("I5189"), "10");
  lines({"I5198=0 F100 X25"});
  EXPECT_EQ(run(), ticks_of(50.0 + 10.0)) << "0: none";
}

TEST_F(MoveTiming, TimeUnitIsx90MakesItPerMinute) {
  ASSERT_EQ(host("CLOSE I5190=60000 OPEN ROT"), "");
  lines({"TA10 TS0 F600 X5"});
  EXPECT_EQ(run(), ticks_of(500.0 + 10.0));
}

TEST_F(MoveTiming, AxesOutsideTheVector) {
  ASSERT_EQ(host("CLOSE I5186=0 OPEN ROT"), "");
  lines({"TA10 TS0 F100 A30 C-50"});  // no feedrate axis: the longest distance / F
  EXPECT_EQ(run(), ticks_of(500.0 + 10.0));
  platform::power_up();
  ASSERT_EQ(host("I5186=20 I5113=10 DEF ROT 50 B0 OPEN ROT"), "");
  lines({"TA10 TS0 F100 X50 A16"});  // X alone 500 ms, A at Isx86 = 20: 800 ms
  EXPECT_EQ(run(), ticks_of(800.0 + 10.0));
}

TEST_F(MoveTiming, AxesOutsideTheVectorAloneGoByIsx86) {
  ASSERT_EQ(host("CLOSE I5186=20 I5113=10 OPEN ROT"), "");
  lines({"TA10 TS0 F100 A16 B-8"});  // 16 at 20 a second
  EXPECT_EQ(run(), ticks_of(800.0 + 10.0));
}

// motion:5.2/7
TEST_F(MoveTiming, Isx86IsOfSegmentedMovesOnly) {
  ASSERT_EQ(host("CLOSE I5186=20 OPEN ROT"), "");
  lines({"TA10 TS0 F100 X50 A16"});
  EXPECT_EQ(run(), ticks_of(500.0 + 10.0));
  platform::power_up();
  ASSERT_EQ(host("I5186=20 DEF ROT 50 B0 OPEN ROT"), "");
  lines({"TA10 TS0 F100 A16"});
  EXPECT_EQ(run(), ticks_of(160.0 + 10.0));
}

TEST_F(MoveTiming, MoveIsNotShorterThanItsAcceleration) {
  lines({"TM10 TA80 TS0 X1"});
  EXPECT_EQ(run(), ticks_of(80.0 + 80.0));
}

TEST_F(MoveTiming, TwiceTsCountsAsTa) {
  lines({"TM100 TA10 TS30 X1"});
  EXPECT_EQ(run(), ticks_of(100.0 + 60.0));
}

TEST_F(MoveTiming, HalfAMillisecondWithoutAcceleration) {
  lines({"TM0 TA0 TS0 X1"});
  EXPECT_EQ(run(), ticks_of(0.5));
}

TEST_F(MoveTiming, ConsecutiveMovesBlendAndLoseNoTime) {
  lines({"TM100 TA40 TS0 X10", "X20", "X30", "X40 Y5"});
  EXPECT_EQ(run(), ticks_of(4 * 100.0 + 40.0));
  EXPECT_EQ(cs().position[AXIS_X], 40.0);
  EXPECT_EQ(cs().position[AXIS_Y], 5.0);
}

TEST_F(MoveTiming,
       BlendUsesTheLaterMovesAcceleration) {  // corners stay Tm apart; only first and last Ta count from and to rest
  lines({"TM100 TA40 TS0 X10", "TA80 X20", "TA20 X30"});
  EXPECT_EQ(run(), ticks_of(40.0 / 2 + 3 * 100.0 + 20.0 / 2));
}

TEST_F(MoveTiming, BlendingCanBeTurnedOff) {
  ASSERT_EQ(host("CLOSE I5192=1 OPEN ROT"), "");
  lines({"TM100 TA40 TS0 X10", "X20"});
  EXPECT_EQ(run(), 2 * ticks_of(140.0));
}

TEST_F(MoveTiming, RapidIsNotBlended) {
  lines({"TM100 TA40 TS0 RAPID X10", "X20"});
  EXPECT_EQ(run(), 2 * ticks_of(140.0));
  EXPECT_EQ(motion_cs_status(0, 1) & 0x13u, 0x02u);  // mode bits 4, 1, 0
}

TEST_F(MoveTiming, NothingBlendsWithARapidMoveBeforeIt) {
  lines({"TM100 TA40 TS0 RAPID X10", "LINEAR X20"});
  EXPECT_EQ(run(), 2 * ticks_of(140.0));
}

TEST_F(MoveTiming, DelayBlendsLikeAMove) {
  lines({"TM100 TA40 TS0 X10", "DELAY70", "X20"});
  EXPECT_EQ(run(), ticks_of(100.0 + 70.0 + 100.0 + 40.0));
}

TEST_F(MoveTiming, DwellStopsBlending) {
  lines({"TM100 TA40 TS0 X10", "DWELL25"});
  EXPECT_EQ(run(), ticks_of(140.0) + ticks_of(25.0));
}

TEST_F(MoveTiming, ATimeBelowZeroIsNone) {
  lines({"TM100 TA40 TS0 X10", "DWELL(0-25)", "DELAY(0-25)", "X20"});
  EXPECT_NEAR(run(), ticks_of(140.0) + ticks_of(40.0 + 100.0 + 40.0), 2) << "DELAY takes TA";
}

TEST_F(MoveTiming, NothingIsCalculatedDuringADwell) {
  lines({"DWELL25", "X10", "X20"});
  ASSERT_EQ(host("R"), "");
  platform::real_time();
  EXPECT_EQ(host("PR"), "2");
  platform::servo_ticks(ticks_of(25.0));
  EXPECT_EQ(host("PR"), "2");
  platform::servo_ticks(6);
  EXPECT_EQ(host("PR"), "0") << "X10 executes, X20 is calculated";
}

TEST_F(MoveTiming, DwellOnTheLineOfAMoveComesAfterIt) {
  lines({"TM100 TA40 TS0 X10 DWELL(P1+25)"});
  EXPECT_EQ(run(), ticks_of(140.0) + ticks_of(25.0));
  EXPECT_EQ(cs().position[AXIS_X], 10.0);
}

TEST_F(MoveTiming, TimeBaseStretchesMovesButNotDwell) {
  lines({"TM100 TA40 TS0 X10", "DWELL25"});
  ASSERT_EQ(host("CLOSE I5194=8388607"), "");
  ASSERT_EQ(host("%50"), "");
  platform::servo_ticks(1);  // the slew reaches 50 % at once
  EXPECT_EQ(host("%"), "50.00001346") << "1856996 of 3713991 units: I10 is odd; ten digits";
  const double slow = 140.0 * 8388608.0 / 1856996.0;
  EXPECT_EQ(run(), static_cast<unsigned>(std::ceil(slow)) + ticks_of(25.0));
}

TEST_F(MoveTiming, TimeBaseSlewsAtIsx94) {
  ASSERT_EQ(host("%0"), "");
  platform::servo_ticks(100);
  EXPECT_EQ(cs().increment, platform::kDefaultI10 - 100 * 1644);
}

// `%` followed by a sign is no report with something behind it, and a refused value leaves the time base alone. The
// limit is that of a signed word: (2^23 - 1) / I10 is 225.8649 %.
TEST_F(MoveTiming, TimeBaseTakesNoSignAndNothingBeyondItsWord) {
  ASSERT_EQ(host("CLOSE I5194=8388607"), "");
  ASSERT_EQ(host("%225"), "");
  platform::servo_ticks(1);
  EXPECT_EQ(cs().increment, (platform::kDefaultI10 * 9 + 2) / 4);
  ASSERT_EQ(host("%225.8649"), "");
  ASSERT_EQ(host("%100"), "");
  platform::servo_ticks(1);
  for (const char* refused : {"%-1", "%+1", "%-0", "% -1", "%-", "%-.5", "%225.87", "%1000"}) {
    EXPECT_EQ(host(refused), "ERR003") << refused;
    platform::servo_ticks(1);
    EXPECT_EQ(cs().increment, platform::kDefaultI10) << refused;
  }
  EXPECT_EQ(host("%"), "100");
  EXPECT_EQ(host("&2%"), "100");
}

TEST_F(MoveTiming, NewI10CountsWithPercent100) {
  ASSERT_EQ(host("CLOSE I10=4000000"), "");
  platform::servo_ticks(3);
  EXPECT_EQ(cs().increment, platform::kDefaultI10);
  ASSERT_EQ(host("I5194=8388607"), "");
  ASSERT_EQ(host("%100"), "");
  platform::servo_ticks(1);
  EXPECT_EQ(cs().increment, 4000000);
}

// firmware:4.10/7: % takes over I10, for its report and for DWELL too.
TEST_F(MoveTiming, NewI10IsWhole100PercentAndTheTimeOfADwell) {
  lines({"DWELL100"});
  ASSERT_EQ(host("CLOSE I10=7427982 I5194=8388607"), "");  // twice the default
  ASSERT_EQ(host("%100"), "");
  platform::servo_ticks(1);
  EXPECT_EQ(host("%"), "100");
  EXPECT_EQ(run(), ticks_of(50.0));
}

TEST_F(MoveTiming, OneMoveIsCalculatedAhead) {
  lines({"TM100 TA40 TS0 X1", "X2", "X3", "X4"});
  ASSERT_EQ(host("R"), "");
  EXPECT_EQ(host("PR"), "4");
  platform::real_time();
  EXPECT_EQ(host("PR"), "3");
  platform::real_time();
  EXPECT_EQ(host("PR"), "3") << "the first has not started yet";
  platform::servo_ticks(3);
  EXPECT_EQ(host("PR"), "2") << "X1 executes, X2 is ready";
  platform::servo_ticks(ticks_of(100.0) - 6);
  EXPECT_EQ(host("PR"), "2");
  platform::servo_ticks(9);
  EXPECT_EQ(host("PR"), "1");
}

TEST_F(MoveTiming, LineBeforeTheDecelerationBlends) {
  lines({"TM100 TA40 TS0 X10"});
  ASSERT_EQ(host("R"), "");
  platform::real_time();
  platform::servo_ticks(1);
  const unsigned before = ticks_of(100.0) - 9;  // the stop begins after Tm
  platform::servo_ticks(before);
  ASSERT_EQ(host("X20"), "");
  unsigned ticks = before;
  while (cs().active) {
    platform::servo_ticks(1);
    ++ticks;
  }
  EXPECT_EQ(ticks, ticks_of(100.0 + 100.0 + 40.0));
}

TEST_F(MoveTiming, LineAfterTheDecelerationStartsFromRest) {
  lines({"TM100 TA40 TS0 X10"});
  ASSERT_EQ(host("R"), "");
  platform::real_time();
  platform::servo_ticks(1);
  platform::servo_ticks(ticks_of(100.0) + 3);
  ASSERT_EQ(host("X20"), "");
  unsigned ticks = ticks_of(100.0) + 3;
  while (cs().active) {
    platform::servo_ticks(1);
    ++ticks;
  }
  EXPECT_EQ(ticks, 2 * ticks_of(140.0));
  EXPECT_TRUE(run_is_running(0)) << "catching up is no error";
  EXPECT_EQ(motion_cs_status(0, 1) >> 22 & 1u, 0u);
}

}  // namespace
