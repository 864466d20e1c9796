// The times of a path's moves (motion:4.2), and moves that have none.
#include <algorithm>

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

// Up to four moves of a queue that goes round, in ms: times and lengths of the changes at their corners.
class PathProgress : public ::testing::Test {
 protected:
  struct Times {
    double time, acceleration, s;
  };
  void queue(const std::vector<Times>& moves, unsigned first) {
    p_ = {};
    p_.first = first;
    for (const Times& times : moves) {
      path_set_times(path_of(&p_, p_.count), times.time, times.acceleration, times.s);
      if (p_.count++ != 0) path_blend(&p_, p_.count - 1, path_time(0));
    }
  }
  static double ms(std::int64_t time) { return static_cast<double>(time) / 4294967296.0; }
  double change(unsigned i) { return ms(path_of(&p_, i)->change); }
  double corner(unsigned i) { return ms(path_corner(&p_, i)); }
  // Of a change about a time, with the share of S that its length has of the acceleration.
  static double rises(double t, double centre, double length, const Times& of) {
    const double s = length >= of.acceleration ? of.s : of.s * length / of.acceleration;
    return risen(t - centre + length / 2, length, s);
  }
  static path p_;
};
path PathProgress::p_;

// motion:5.2: each move's velocity rises about its corner and falls about the next by what that one gains; the last
// falls to rest where it stops, as far as its time has room.
TEST_F(PathProgress, PartsAreTheWaysOfChangesAboutCorners) {
  const std::vector<Times> all = {{100, 20, 0}, {60, 40, 12}, {35, 50, 25}, {200, 10, 5}};
  for (unsigned first = 0; first < PATH_MOVES; ++first)
    for (unsigned count = 1; count <= all.size(); ++count)
      for (const bool stops : {true, false}) {
        queue({all.begin(), all.begin() + count}, first);
        const double stop = std::min(all[count - 1].acceleration, 2 * all[count - 1].time - change(count - 1));
        EXPECT_NEAR(ms(path_ends(&p_, count)), corner(count) + stop / 2, 1e-8);
        for (double t = -30; t < corner(count) + stop; t += 1.75) {
          path_point point;
          path_at(&p_, {count, stops}, path_time(t), &point);
          ASSERT_EQ(point.count, count);
          for (unsigned i = 0; i < count; ++i) {
            double made = rises(t, corner(i), change(i), all[i]);
            if (i + 1 < count)
              made -= rises(t, corner(i + 1), change(i + 1), all[i + 1]);
            else if (stops)
              made -= rises(t, corner(count), stop, all[i]);
            made = std::max(0.0, std::min(1.0, made / all[i].time));
            ASSERT_NEAR(static_cast<double>(point.parts[i]) / 4611686018427387904.0, made, 1e-9)
                << t << ", " << i << " of " << count << (stops ? ", stops" : "");
          }
        }
      }
}

// A change of velocity has the move's acceleration time, as far as the one before leaves room and the corner is ahead.
TEST_F(PathProgress, ABlendHasTheRoomThatThereIs) {
  const struct {
    double time, change, acceleration, now, expected;
  } cases[] = {{100, 20, 30, 0, 30},  {100, 20, 190, 0, 180}, {100, 20, 30, 84, 30},
               {100, 20, 30, 86, 28}, {100, 20, 30, 100, 0},  {100, 20, 30, 120, 0},
               {40, 50, 60, 0, 30},   {40, 0, 60, 0, 60},     {40, 0, 100, -50, 80}};
  for (const auto& c : cases) {
    p_ = {};
    p_.count = 2;
    path_set_times(&p_.moves[0], c.time, 5, 0);
    path_set_times(&p_.moves[1], 70, c.acceleration, 0);
    p_.moves[0].change = path_time(c.change);
    path_blend(&p_, 1, path_time(c.now));
    EXPECT_EQ(p_.moves[1].change, path_time(c.expected)) << c.acceleration << " at " << c.now;
    EXPECT_EQ(path_begins(&p_, 1), path_time(c.time - c.expected / 2));
    EXPECT_EQ(path_begins(&p_, 0), path_time(-c.change / 2));
    EXPECT_EQ(path_corner(&p_, 2), path_time(c.time + 70));
    EXPECT_EQ(path_pop(&p_), path_time(c.time));
    EXPECT_EQ(p_.first, 1u);
    EXPECT_EQ(p_.count, 1u);
    EXPECT_EQ(path_corner(&p_, 1), path_time(70));
  }
  p_.first = PATH_MOVES - 1;
  path_set_times(&p_.moves[PATH_MOVES - 1], 9, 1, 0);
  EXPECT_EQ(path_pop(&p_), path_time(9));
  EXPECT_EQ(p_.first, 0u) << "it goes round";
}

// What of each move is made adds up from where the first one begins; the way of one that stands has no direction.
TEST_F(PathProgress, AxesAreWhereTheirMovesHaveThem) {
  queue({{10, 1, 0}, {10, 1, 0}, {10, 1, 0}}, 2);
  double at[AXIS_COUNT] = {}, to[AXIS_COUNT];
  for (unsigned i = 0; i < 3; ++i)
    for (unsigned axis = 0; axis < AXIS_COUNT; ++axis) {
      path_move* m = path_of(&p_, i);
      m->start[axis] = i == 0 ? axis : path_of(&p_, i - 1)->end[axis];
      m->delta[axis] = axis == AXIS_V ? 0 : 10.0 * i + axis - 3;
      m->end[axis] = m->start[axis] + m->delta[axis];
    }
  const std::int64_t parts[][3] = {{0, 0, 0},
                                   {PATH_WHOLE / 4, 0, 0},
                                   {PATH_WHOLE, PATH_WHOLE / 2, 0},
                                   {PATH_WHOLE / 8 * 7, PATH_WHOLE / 8, 0},
                                   {PATH_WHOLE, PATH_WHOLE, PATH_WHOLE / 16},
                                   {PATH_WHOLE, PATH_WHOLE, PATH_WHOLE}};
  for (const auto& part : parts) {
    path_point point = {3, {part[0], part[1], part[2]}};
    path_axes_at(&p_, &point, at);
    for (unsigned axis = 0; axis < AXIS_COUNT; ++axis) {
      double expected = axis;
      for (unsigned i = 0; i < 3; ++i)
        expected += path_of(&p_, i)->delta[axis] * static_cast<double>(part[i]) / static_cast<double>(PATH_WHOLE);
      EXPECT_NEAR(at[axis], expected, 1e-12) << axis;
    }
  }
  for (const bool stands : {false, true}) {
    path_of(&p_, 1)->stands = stands;
    path_direction(path_of(&p_, 1), 0.5, to);
    for (unsigned axis = 0; axis < AXIS_COUNT; ++axis)
      EXPECT_EQ(to[axis], stands || axis == AXIS_V ? 0.0 : 10.0 + axis - 3) << axis;
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
  for (const char* line : {"J0 I5 X10", "X10 J0 I5", "R5 X10", "J0 X10 I5", "X10 I5 J0 DWELL1"}) {
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
    EXPECT_EQ(coordinate_systems[0].pending_vectors, 0u) << "a matrix has turned them already";
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
