// The times of a path's moves (motion:4.2), and moves that have none.
#include "testbench/unit/firmware_program/moving_motors.h"

extern "C" {
#include "firmware/motion/path.h"
}

namespace {

using namespace moving_motors;

// A move that is shorter than its acceleration stops within itself: what its beginning takes is gone.
TEST(Path, TheLastStopHasTheRoomThatIsLeft) {
  static path p;
  p = {};
  p.count = 1;
  path_set_times(&p.moves[0], 10, 20, 0);
  p.moves[0].change = path_time(4);
  EXPECT_EQ(path_ends(&p, 1), path_time(10) + path_time(2 * 10 - 4) / 2);
  path_set_times(&p.moves[0], 10, 8, 0);
  p.moves[0].change = path_time(4);
  EXPECT_EQ(path_ends(&p, 1), path_time(10) + path_time(8) / 2);
}

// motion:5.1/2: behind its end a move is where its axes are to end, to the bit; start and way alone miss it.
TEST(Path, AnEndIsThePositionThatIsWritten) {
  static path p;
  static double position[AXIS_COUNT];
  p = {};
  p.count = 2;
  const double ends[] = {0.9, 0.3};
  for (int i = 0; i < 2; ++i) {
    path_move& m = p.moves[i];
    m.start[AXIS_X] = i == 0 ? 0.2 : ends[0];
    m.end[AXIS_X] = ends[i];
    m.delta[AXIS_X] = m.end[AXIS_X] - m.start[AXIS_X];
  }
  ASSERT_NE(p.moves[0].start[AXIS_X] + p.moves[0].delta[AXIS_X], ends[0]);
  for (std::uint32_t count = 1; count <= 2; ++count) {
    path_point point;
    path_at_end(count, &point);
    EXPECT_EQ(point.count, count);
    path_axes_at(&p, &point, position);
    EXPECT_EQ(position[AXIS_X], ends[count - 1]);
  }
}

class PathErrors : public MovingMotors {};
class PathLoops : public MovingMotors {};

// firmware:7.10: a feedrate of 0 is error 8, whatever plans the move.
TEST_F(PathErrors, AFeedrateOfZeroIsOneWithAndWithoutSegments) {
  for (const char* isx13 : {"I5113=0", "I5113=5"})
    for (const char* line : {"LINEAR X1", "CIRCLE1 X1 Y1 I1 J0"}) {
      SCOPED_TRACE(std::string(isx13) + " " + line);
      platform::power_up();
      fit({"1000X", "1000Y"});
      ASSERT_EQ(host(isx13), "");
      store({"INC TA20 TS0 F0", line});
      ASSERT_EQ(host("&1B1R"), "");
      platform::servo_ticks(ticks_of(100));
      EXPECT_FALSE(run_is_running(0));
      EXPECT_EQ(host("RY$2014"), "8");
      EXPECT_EQ(motors[0].trajectory, 0);
    }
}

// firmware:7.5/11: all of the move is met again, its I, J, K or R too, be they before its axes.
TEST_F(PathErrors, BehindAnErrorTheArcIsMetAgain) {
  Lines lead;
  for (const char* line : {"J0 I5 X10", "X10 J0 I5", "R5 X10", "J0 X10 I5"}) {
    SCOPED_TRACE(line);
    platform::power_up();
    fit({"1000X", "1000Y"});
    lead.emplace_back("P1=1 P2=2 P3=3 P4=4 P5=5 P6=6");  // each at a place of its own
    Lines lines = lead;
    lines.insert(lines.end(), {"INC TA20 TS0 F0 CIRCLE1", line});
    store(lines);
    ASSERT_EQ(host("I5113=10 I5190=1000 B1R"), "");
    platform::servo_ticks(ticks_of(100));
    ASSERT_EQ(host("RY$2014"), "8");
    ASSERT_EQ(motors[0].trajectory, 0);
    ASSERT_EQ(host("I5189=50 R"), "");
    double highest = 0;
    for (int i = 0; i < 3000 && run_is_running(0); ++i) {
      platform::servo_ticks(1);
      highest = std::max(highest, at(2));
    }
    EXPECT_FALSE(run_is_running(0));
    EXPECT_EQ(host("RY$2014"), "0");
    EXPECT_EQ(at(1), 10000);
    EXPECT_NEAR(highest, 5000, 100) << "half a circle of radius 5, clockwise";
  }
}

// firmware:7.9/3: two jumps back end blending where no move lies between them; moves that a loop makes one behind the
// other blend, however many are calculated in an interrupt. From rest to rest 40 of 20 ms take 800 + 10 + 2 Isx13.
TEST_F(PathLoops, MovesOfALoopBlend) {
  for (const auto& [begins, ends] : {std::pair{"WHILE(P1<40)", "ENDWHILE"}, {"N1", "IF(P1<40) GOTO1"}}) {
    SCOPED_TRACE(begins);
    platform::power_up();
    fit({"1000X"});
    ASSERT_EQ(host("I5113=10 P1=0"), "");
    store({"INC TM20 TA10 TS0", begins, "P1=P1+1 X1", ends});
    EXPECT_NEAR(run(), 830, 5);
    EXPECT_EQ(at(1), 40000);
  }
}

// The same rule from its other side: behind one jump back the next move blends, behind two it begins from rest.
TEST_F(PathLoops, TwoJumpsBackEndBlending) {
  for (const auto& [jumps, ms] : {std::pair{"0", 240 + 20}, {"1", 240 + 20}, {"2", 240 + 40}, {"5", 240 + 40}}) {
    SCOPED_TRACE(jumps);
    platform::power_up();
    fit({"1000X"});
    store({"INC TM120 TA20 TS0 P1=0 X1", std::string("WHILE(P1<") + jumps + ")", "P1=P1+1", "ENDWHILE", "X1"});
    EXPECT_NEAR(run(), ms, 2);
    EXPECT_EQ(at(1), 2000);
  }
}

}  // namespace
