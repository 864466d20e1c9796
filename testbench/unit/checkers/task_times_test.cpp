// Own times of tasks and what they take of a span, from changes of cpu.task as the machine tells them.
#include "testbench/checkers/task_times.h"

#include <gtest/gtest.h>

namespace brick {
namespace {

constexpr unsigned kBackground = TaskTimes::kBackground, kRealTime = TaskTimes::kRealTime, kServo = TaskTimes::kServo,
                   kPhase = TaskTimes::kPhase;

TEST(TaskTimes, ARunIsAsLongAsItIsLessWhatInterruptsIt) {
  TaskTimes times;
  times.changed(100, kRealTime);
  times.changed(130, kServo);
  times.changed(135, kPhase);
  times.changed(142, kServo);
  times.changed(150, kRealTime);
  times.changed(190, kBackground);
  EXPECT_EQ(times.runs(kPhase).longest, 7);
  EXPECT_EQ(times.runs(kServo).longest, 5 + 8);
  EXPECT_EQ(times.runs(kRealTime).longest, 30 + 40);
  EXPECT_EQ(times.runs(kRealTime).count, 1u);
}

TEST(TaskTimes, TheHostPortsHandlerIsNoPartOfARunButOfASpan) {
  TaskTimes times;
  times.changed(100, kServo);
  times.changed(110, kServo);  // the handler
  times.changed(125, kServo);
  times.changed(140, kBackground);
  EXPECT_EQ(times.runs(kServo).longest, 10 + 15);
  EXPECT_EQ(times.above_background(0, 1000), 40);
}

TEST(TaskTimes, TheHandlerOfTheBackgroundIsTheBackgrounds) {
  TaskTimes times;
  times.changed(100, kBackground);
  times.changed(110, kBackground);
  times.changed(120, kPhase);
  times.changed(123, kBackground);
  EXPECT_EQ(times.above_background(0, 1000), 3);
  EXPECT_EQ(times.runs(kPhase).longest, 3);
}

TEST(TaskTimes, OneRunBehindAnotherIsTwo) {
  TaskTimes times;
  for (const TimeFs at : {100, 200}) {
    times.changed(at, kPhase);
    times.changed(at + 9, kBackground);
  }
  EXPECT_EQ(times.runs(kPhase).count, 2u);
  EXPECT_EQ(times.runs(kPhase).longest, 9);
  times.forget_runs();
  EXPECT_EQ(times.runs(kPhase).count, 0u);
}

TEST(TaskTimes, ASpanTakesPartsOfRunsAtItsEnds) {
  TaskTimes times;
  times.changed(100, kRealTime);
  times.changed(140, kServo);
  times.changed(160, kRealTime);
  times.changed(200, kBackground);
  EXPECT_EQ(times.above_background(90, 95), 0);
  EXPECT_EQ(times.above_background(90, 110), 10);
  EXPECT_EQ(times.above_background(150, 250), 50);
  EXPECT_EQ(times.above_background(0, 1000), 100);
  times.changed(300, kServo);
  times.forget_changes();
  EXPECT_EQ(times.above_background(310, 330), 20) << "still under way";
}

}  // namespace
}  // namespace brick
