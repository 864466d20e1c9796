// A move of one mode behind moves of another (motion:5.4, motion:5.6, motion:7.1): where stops leave the motors, what
// is there in time, and that no motor ever leaps.
#include "testbench/unit/firmware_platform/fake_tasks.h"
#include "testbench/unit/firmware_program/moving_motors.h"

namespace {

using namespace moving_motors;

class ChangingModes : public MovingMotors {
 protected:
  // 30 counts a ms is the most that motors go for themselves.
  static void begin(const std::string& settings) {
    platform::power_up();
    fit({"1000X", "1000Y"});
    for (const char* i : {"I1", "I2"}) {
      const std::string n = i;
      ASSERT_EQ(host(n + "15=1 " + n + "19=1 " + n + "20=20 " + n + "21=0 " + n + "22=30 " + n + "92=1"), "");
    }
    ASSERT_EQ(host("I5195=200000 I5194=200000 DELETE GATHER"), "");
    ASSERT_EQ(host("&1DEFINE LOOKAHEAD 200,30"), "");
    ASSERT_EQ(host(settings), "");
  }
  // Over `ms`: no motor goes faster than `fastest` counts a ms, the first one never back.
  void go(double ms, double fastest) {
    for (unsigned n = ticks_of(ms); n > 0; --n) {
      const double before[] = {at(1), at(2)};
      platform::servo_ticks(1);
      for (unsigned i = 0; i < 2; ++i) {
        const double step = at(i + 1) - before[i];
        ASSERT_LE(std::abs(step), fastest * kTickMs * 1.001 + 0.01) << "#" << i + 1 << " from " << before[i];
        if (i == 0) { ASSERT_GE(step, -0.01) << "from " << before[i]; }
      }
    }
  }
  static bool stands() { return !run_is_running(0) && !cs().active && piece_ring_is_empty(&cs().ring); }
};

// motion:7.1/8: three lines of 100 ms that blend, with changes of velocity of 20 ms. Segments of 10 ms are made 80 ms
// ahead at most, so at 20 ms the last one lies in X1 and at 250 ms in X3. A move of another kind is behind all of them.
TEST_F(ChangingModes, AStopLeavesOutWhatIsBehindTheMoveThatEnds) {
  const struct {
    Lines lines;
    double ends;
  } lasts[] = {{{"SPLINE1 TM100 X3.5", "RAPID X4"}, 4000}, {{"SPLINE2 TM100 X3.5", "X4"}, 4000},
               {{"PVT100 X3.5:0", "RAPID X4"}, 4000},      {{"RAPID X3.5", "X4"}, 4000},
               {{"CIRCLE1 X3.5 R1", "RAPID X4"}, 4000},    {{"I5113=0", "LINEAR X3.5", "X4"}, 4000},
               {{"DWELL100", "LINEAR X4"}, 4000},          {{"PSET X3", "RAPID X4"}, 4000}};
  const struct {
    double at, least, most;
  } stops[] = {{20, 1000, 1000}, {80, 1000, 2000}, {130, 2000, 3000}, {250, 3000, 3000}};
  for (const auto& last : lasts)
    for (const char* order : {"&1Q", "&1/", "&1S"})
      for (const char* ahead : {"I5120=0", "I5120=2"})
        for (const auto& stop : stops) {
          SCOPED_TRACE(last.lines.front() + " " + order + " " + ahead + " at " + std::to_string(stop.at));
          begin(std::string("I5113=10 ") + ahead);
          Lines lines = {"LINEAR ABS TM100 TA20 TS0", "X1", "X2", "X3"};
          lines.insert(lines.end(), last.lines.begin(), last.lines.end());
          store(lines);
          ASSERT_EQ(host("&1B1R"), "");
          go(stop.at, 30);
          ASSERT_EQ(host(order), "");
          go(500, 30);
          ASSERT_TRUE(stands());
          ASSERT_GE(at(1), stop.least);
          if (ahead[6] == '0') { ASSERT_LE(at(1), stop.most); }
          const bool blends = last.lines.front() == "CIRCLE1 X3.5 R1" && at(1) == 3500;
          ASSERT_TRUE(at(1) == 1000 || at(1) == 2000 || at(1) == 3000 || blends) << at(1);
          ASSERT_EQ(host("&1R"), "");
          go(1000, 30);
          ASSERT_TRUE(stands());
          EXPECT_EQ(motors[0].trajectory, std::llround(last.ends * kUnit));
          EXPECT_EQ(cs().error, RUN_TIME_NONE);
        }
}

// A line that becomes one of another mode behind its axes has begun: what is before it is left out all the same.
TEST_F(ChangingModes, AStopLeavesOutWhatABegunLineWaitsFor) {
  begin("I5113=10 I5120=0");
  store({"LINEAR ABS TM100 TA20 TS0", "X1", "X2", "X3.5 SPLINE1 TM100", "X4"});
  ASSERT_EQ(host("&1B1R"), "");
  go(20, 30);
  ASSERT_EQ(host("&1Q"), "");
  go(500, 30);
  ASSERT_TRUE(stands());
  EXPECT_EQ(motors[0].trajectory, 1000 * 3072);
  ASSERT_EQ(host("&1R"), "");
  go(1000, 30);
  ASSERT_TRUE(stands());
  EXPECT_EQ(motors[0].trajectory, 4000 * 3072);
}

// Statements and jumps between them are no moves: they are executed while the segments before are still to come.
TEST_F(ChangingModes, StatementsBehindSegmentsDoNotWaitForTheirEnd) {
  begin("I5113=10 I5120=40 P1=0");
  store({"LINEAR ABS TM3000 TA20 TS0 X1", "RAPID", "GOTO 5", "N5 P1=1", "X4"});
  ASSERT_EQ(host("&1B1R"), "");
  go(150, 30);
  EXPECT_LT(motors[0].trajectory, 900 * 3072) << "it is on its way yet";
  EXPECT_EQ(host("P1"), "1");
  go(4000, 30);
  EXPECT_EQ(motors[0].trajectory, 4000 * 3072);
}

// A search for home too.
TEST_F(ChangingModes, AStopLeavesOutASearchForHome) {
  for (const char* order : {"&1Q", "&1/", "&1S"}) {
    begin("I5113=10 I5120=0 I223=10 I225=$78000");
    store({"LINEAR ABS TM100 TA20 TS0", "X1", "X2", "HOME2", "RAPID X4"});
    ASSERT_EQ(host("&1B1R"), "");
    go(20, 30);
    ASSERT_EQ(host(order), "");
    go(500, 30);
    ASSERT_TRUE(stands());
    EXPECT_EQ(motors[0].trajectory, 1000 * 3072) << order;
    EXPECT_EQ(motors[1].trajectory, 0) << order;
    ASSERT_EQ(host("&1R"), "");
    go(500, 30);
    EXPECT_EQ(motors[0].trajectory, 2000 * 3072) << order;
    EXPECT_GT(motors[1].trajectory, 1000 * 3072) << order << ": it looks for it still";
  }
}

// motion:5.4/3: 1000 counts in 150 ms from rest to 5 counts a ms, 9 at most. What comes behind it in time, whatever it
// is, begins at its end and from rest.
TEST_F(ChangingModes, WhatIsBehindPvtInMotionBeginsAtItsEnd) {
  const struct {
    Lines lines;
    double x, y, stands;  // ends; ms that motor 1 stays at the end of the PVT move
  } nexts[] = {{{"LINEAR TM100 Y1", "X3"}, 3000, 1000, 80},
               {{"LINEAR TM100 INC X2"}, 3000, 0, 0},
               {{"LINEAR DELAY100", "X3"}, 3000, 0, 90},
               {{"CIRCLE1 TM100 X3 R2"}, 3000, 0, 0},
               {{"RAPID X3"}, 3000, 0, 0},
               {{"HOME2", "RAPID X3"}, 1000, 0, 300},
               {{"DWELL100", "X3"}, 3000, 0, 100},
               {{"SPLINE1 TM100 X3"}, 3000, 0, 0},
               {{"DWELL0 PVT100 X3:0"}, 3000, 0, 0}};
  for (const auto& next : nexts)
    for (const char* settings : {"I5113=0", "I5113=5", "I5113=5 I5120=40", "I5113=5 I5181=300 I5182=10"}) {
      SCOPED_TRACE(next.lines.front() + " " + settings);
      begin(std::string(settings) + " I223=10 I225=$78000 I128=8000000 I228=8000000");
      Lines lines = {"TA20 TS0 PVT150 X1:5"};
      lines.insert(lines.end(), next.lines.begin(), next.lines.end());
      store(lines);
      ASSERT_EQ(host("&1B1R"), "");
      for (int i = 0; i < 200 && !cs().active; ++i) platform::servo_ticks(1);
      go(150 - kTickMs, 9);
      ASSERT_NEAR(at(1), 1000, 2 * kTickMs * 5.1);
      go(2 * kTickMs, 9);
      ASSERT_NEAR(at(1), 1000, 0.1) << "a LINEAR move has begun at most";
      const std::int64_t stands = motors[0].trajectory;
      go(next.stands, 30);
      EXPECT_TRUE(next.stands == 0 || motors[0].trajectory == stands);
      go(700, 30);
      EXPECT_EQ(motors[0].trajectory, std::llround(next.x * kUnit));
      if (next.lines.front() != "HOME2") { EXPECT_EQ(motors[1].trajectory, std::llround(next.y * kUnit)); }
      EXPECT_EQ(cs().error, RUN_TIME_NONE);
    }
}

// The PVT move comes to its end while the next one is calculated and placed: that begins at its end, or it is late, and
// the motor runs on, by 5 counts a ms and then a ramp of 12.5 counts.
TEST_F(ChangingModes, APlaceBehindPvtInMotionIsInTimeOrLate) {
  unsigned in_time = 0, late = 0;
  for (const char* settings : {"I5113=0", "I5113=5"})
    for (const char* next : {"LINEAR TM100 X3 Y1", "RAPID X3 Y1", "DWELL10 X3 Y1", "SPLINE1 TM100 X3 Y1"})
      for (const unsigned pauses : {1u, 3u, 10u, 40u})
        for (unsigned left = 0; left < 12; ++left) {
          SCOPED_TRACE(std::string(next) + " " + settings + ", " + std::to_string(left) + " interrupts before, " +
                       std::to_string(pauses) + " pauses an interrupt");
          begin(settings);
          store({"TA20 TS0 PVT150 X1:5", next});
          ASSERT_EQ(host("&1B1R"), "");
          for (int i = 0; i < 200 && !cs().active; ++i) platform::servo_ticks(1);
          ASSERT_FALSE(cs().next_valid);
          double last = at(1);
          const auto servo = [&] {
            fake_task_run_servo();
            ASSERT_LE(std::abs(at(1) - last), 30 * kTickMs + 0.01) << "from " << last;
            last = at(1);
          };
          for (unsigned i = ticks_of(150); i > left; --i) servo();
          unsigned count = 0;
          platform::real_time_in_slices([&] {
            if (++count % pauses == 0 && count < 60 * pauses) servo();
          });
          go(700, 30);
          ASSERT_TRUE(stands());
          const bool is_late = cs().error == RUN_TIME_LATE;
          (is_late ? late : in_time)++;
          if (is_late) {
            ASSERT_LT(at(1), 1000 + 12.5 + 5 * 100 * kTickMs);
            ASSERT_GT(at(1), 1000 + 12.5);
          } else {
            ASSERT_EQ(cs().error, RUN_TIME_NONE);
            ASSERT_EQ(motors[0].trajectory, 3000 * 3072);
          }
        }
  EXPECT_GT(in_time, 50u);
  EXPECT_GT(late, 50u);
}

// A stop and then the end of the PVT move come while the next one is calculated: behind it that is late, and lost.
TEST_F(ChangingModes, AMoveThatIsLateIsAnErrorBehindAStopToo) {
  for (const char* settings : {"I5113=0", "I5113=5"}) {
    unsigned late = 0;
    for (unsigned when = 1; when < 60; ++when) {
      SCOPED_TRACE(std::string(settings) + ", pause " + std::to_string(when));
      begin(settings);
      store({"TA20 TS0 PVT150 X1:5", "LINEAR TM100 X3 Y1"});
      ASSERT_EQ(host("&1B1R"), "");
      for (int i = 0; i < 200 && !cs().active; ++i) platform::servo_ticks(1);
      for (unsigned i = ticks_of(150); i > 1; --i) fake_task_run_servo();
      const std::uint32_t planned = cs().planned;
      unsigned pauses = 0;
      platform::real_time_in_slices([&] {
        if (cs().pending_axes == 0 || ++pauses != when) return;
        run_quit(0);
        for (int i = 0; i < 4; ++i) fake_task_run_servo();
      });
      if (pauses < when) break;
      const bool calculated = cs().planned != planned;
      go(200, 9);
      ASSERT_TRUE(stands());
      ASSERT_EQ(cs().error, calculated ? RUN_TIME_LATE : RUN_TIME_NONE);
      late += calculated;
    }
    EXPECT_GT(late, 0u) << settings;
  }
}

}  // namespace
