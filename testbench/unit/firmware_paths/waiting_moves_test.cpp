// Moves that wait behind Q, `/` or S in segments, when the motors are somewhere else at the start that follows
// (motion:7.1/8): to absolute places, by distances, along arcs, by kinematic programs; not faster than F.
#include "testbench/unit/firmware_paths/pi.h"
#include "testbench/unit/firmware_paths/spline_path.h"
#include "testbench/unit/firmware_program/moving_motors.h"

extern "C" {
#include "firmware/motion/path.h"
#include "firmware/motion/segment.h"
}

namespace {

using namespace moving_motors;
using spline_path::Spline;

// Of a curve over 0 to 1, in the unit of its places: as a polygon of 100,000 sides.
template <typename Place>
double length_of(const Place& place) {
  constexpr int kSides = 100000;
  double length = 0;
  auto before = place(0);
  for (int i = 1; i <= kSides; ++i) {
    const auto now = place(static_cast<double>(i) / kSides);
    length += std::hypot(now.first - before.first, now.second - before.second);
    before = now;
  }
  return length;
}

class WaitingMoves : public MovingMotors {
 protected:
  static void begin(const Lines& definitions) {
    platform::power_up();
    fit(definitions);
    ASSERT_EQ(host("I5113=5 I5190=1000"), "");
  }
  // 1000 counts a unit, as the definitions have it; X is P10 off and Y P11 as the forward program sees it.
  static void kinematic(const Lines& definitions) {
    for (unsigned i = 0; i < definitions.size(); ++i)
      ASSERT_EQ(host("&1#" + std::to_string(i + 1) + "->" + definitions[i]), "");
    for (const char* line :
         {"&1OPEN FORWARD CLEAR", "Q7=P1/1000+P10 Q8=P2/1000+P11 Q9=P3/1000", "CLOSE", "&1OPEN INVERSE CLEAR",
          "P1=Q7*1000 P2=Q8*1000 P3=Q9*1000", "CLOSE", "I5150=1 P10=0 P11=0"})
      ASSERT_EQ(host(line), "");
  }
  // A line at 10 a s to X1, then `lines`; stopped behind the first.
  static void stop(Lines lines, const std::string& first = "X1") {
    lines.insert(lines.begin(), "F10 TA20 TS0 " + first);
    store(lines);
    ASSERT_EQ(host("&1B1R"), "");
    platform::servo_ticks(ticks_of(60));
    ASSERT_EQ(host("&1Q"), "");
    platform::servo_ticks(ticks_of(200));
    ASSERT_FALSE(run_is_running(0));
    ASSERT_EQ(motors[0].trajectory, 1000 * 3072);
  }
  // All of it, at no more than `fastest` counts a ms.
  static void go_on(double fastest) {
    double before[] = {at(1), at(2), at(3)};
    run(
        [&](double) {
          double square = 0;
          for (unsigned i = 0; i < 3; ++i) {
            square += std::pow(at(i + 1) - before[i], 2);
            before[i] = at(i + 1);
          }
          ASSERT_LE(std::sqrt(square), fastest * kTickMs * 1.002 + 0.01);
        },
        "&1R");
  }
  static void expect_at(const std::vector<double>& places) {
    for (unsigned i = 0; i < places.size(); ++i) EXPECT_EQ(motors[i].trajectory, std::llround(places[i] * kUnit)) << i;
  }
};

// What was to blend with the move before the stop begins from rest, in its own TA: with TS 0 half of the speed after
// half of it.
TEST_F(WaitingMoves, BeginInTheirOwnTime) {
  begin({"1000X"});
  store({"INC TA100 TS0 TM100 X1", "TA300 TM400 X4"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(ticks_of(40));
  ASSERT_EQ(host("&1Q"), "");
  platform::servo_ticks(ticks_of(300));
  ASSERT_EQ(motors[0].trajectory, 1000 * 3072);
  ASSERT_TRUE(segment_is_left(0));
  double before = at(1), ms = 0, begun = -1, half = -1;
  run(
      [&](double) {
        ms += kTickMs;
        const double speed = (at(1) - before) / kTickMs;
        before = at(1);
        if (begun < 0 && speed > 0) begun = ms;
        if (half < 0 && speed >= 5) half = ms;
      },
      "&1R");
  EXPECT_NEAR(half - begun, 150, 5);  // a segment
  EXPECT_EQ(motors[0].trajectory, 5000 * 3072);
}

// A step makes one of them: a line that had begun before the stop, and waits for them, is for the next one.
TEST_F(WaitingMoves, AStepMakesOneThoughALineHasBegun) {
  begin({"1000X"});
  ASSERT_EQ(host("I119=1"), "");
  stop({"X2", "X3 RAPID", "X4"});
  for (const double end : {2000.0, 3000.0, 4000.0}) {
    ASSERT_EQ(host("S"), "");
    platform::servo_ticks(ticks_of(600));
    EXPECT_FALSE(run_is_running(0));
    expect_at({end});
  }
}

// Another program is another start, at once: they are dropped, and nothing moves for that.
TEST_F(WaitingMoves, AnotherProgramBeginsOnTheSameLine) {
  begin({"1000X"});
  store({"X5"}, 2);
  for (const char* start : {"B2R", "B2S"}) {
    ASSERT_EQ(host("#1HMZ"), "");
    stop({"X2", "X3"});
    ASSERT_TRUE(segment_is_left(0));
    ASSERT_EQ(host(start), "");
    platform::servo_ticks(ticks_of(600));
    EXPECT_FALSE(run_is_running(0));
    expect_at({5000});
  }
}

// What is calculated behind them blends with the last one, as without the stop: by the direction that this has now.
TEST_F(WaitingMoves, BlendWithWhatComesBehindThem) {
  const struct {
    Lines lines;
    double last, end;
  } programs[] = {{{"INC X1", "X1", "X1", "X1", "X1"}, 3000, 5000},
                  {{"INC Y0.1", "Y0.1", "ABS X0.5", "X2"}, 500, 2000}};  // the third went down before HMZ
  for (const auto& p : programs) {
    SCOPED_TRACE(p.lines.front());
    begin({"1000X", "1000Y"});
    ASSERT_EQ(host("I5183=0.5"), "");
    stop(p.lines);
    ASSERT_EQ(paths[0].count, 3u);
    ASSERT_EQ(host("#1HMZ"), "");
    double before = at(1), slowest = 1e9;
    run(
        [&](double) {
          if (std::abs(at(1) - p.last) < 100) slowest = std::min(slowest, (at(1) - before) / kTickMs);
          before = at(1);
        },
        "&1R");
    EXPECT_NEAR(slowest, 10, 0.1);
    EXPECT_NEAR(at(1), p.end, 0.01);
  }
}

// Home where it stands: an axis goes to its absolute place from there, or by its distance; one that no line names stays
// at the place that has another name now.
TEST_F(WaitingMoves, GoToAbsolutePlacesAndByDistances) {
  const struct {
    Lines lines;
    std::vector<double> ends;
  } programs[] = {{{"X3", "X6"}, {6000, 0}},
                  {{"INC X2", "X3"}, {5000, 0}},
                  {{"INC X2", "ABS X6"}, {6000, 0}},
                  {{"Y2", "Y4"}, {0, 2000}},
                  {{"Y2", "X2 Y4"}, {2000, 2000}},
                  {{"INC(Y) X3 Y2", "X1"}, {1000, 1000}},
                  {{"INC X2 ABS Y5", "X4"}, {4000, 2500}},
                  {{"DELAY50", "X3"}, {3000, 0}},
                  {{"X1", "Y4"}, {1000, 2000}}};
  for (const auto& p : programs) {
    SCOPED_TRACE(p.lines.front() + " " + p.lines.back());
    begin({"1000X", "500Y"});
    stop(p.lines);
    ASSERT_EQ(host("#1HMZ#2HMZ"), "");
    platform::servo_ticks(5);
    go_on(10);
    expect_at(p.ends);
  }
}

// The way that F counts is longer: it takes as long as that asks for. TM is kept.
TEST_F(WaitingMoves, TakeTheTimeOfTheirWay) {
  for (const bool by_time : {false, true}) {
    begin({"1000X"});
    stop({by_time ? "TM500 X6" : "X6"});
    ASSERT_EQ(host("#1HMZ"), "");
    platform::servo_ticks(5);
    const double time = by_time ? 500 : 600;
    const Spline x([&](double t) { return 6000 * (risen(t, 20, 0) - risen(t - time, 20, 0)) / time; }, time + 20, 5);
    run([&](double t) { ASSERT_NEAR(at(1), x.at(t), 5 / kUnit) << t; }, "&1R");
    expect_at({6000});
  }
}

// Feedrate, feedrate axes and units are those of its line, whatever has been set since. Y would take 4 s, 40 s by
// Isx86.
TEST_F(WaitingMoves, TakeTheTimeThatTheirLinesAskFor) {
  const struct {
    const char *before, *since;
    double time;
  } cases[] = {{"", "I5113=5", 300},   {"", "I5190=100", 300},       {"", "I5186=1", 300},
               {"", "I5189=1", 300},   {"", "I5198=1", 300},         {"I5186=100", "I5186=0", 400},
               {"I5186=100", "", 400}, {"I5186=100", "I5186=1", 400}};
  for (const auto& c : cases) {
    SCOPED_TRACE(std::string(c.before) + " " + c.since);
    begin({"1000X", "500Y"});
    ASSERT_EQ(host(c.before), "");
    stop({"X3 Y40", "FRAX(X,Y) X4"}, "FRAX(X) X1");
    ASSERT_EQ(host("#1HMZ"), "");
    ASSERT_EQ(host(c.since), "");
    platform::servo_ticks(5);
    const auto made = [](double t, double time) { return (risen(t, 20, 0) - risen(t - time, 20, 0)) / time; };
    const Spline x([&](double t) { return 3000 * made(t, c.time) + 1000 * made(t - c.time, 100); }, c.time + 120, 5);
    const Spline y([&](double t) { return 20000 * made(t, c.time); }, c.time + 120, 5);
    double worst = 0;
    run([&](double t) { worst = std::max({worst, std::abs(at(1) - x.at(t)), std::abs(at(2) - y.at(t))}); }, "&1R");
    EXPECT_LE(worst, 10 / kUnit);
    expect_at({4000, 20000});
  }
}

// A line that had no way, and has one now that its feedrate does not make: as the line would do, it is a run-time
// error.
TEST_F(WaitingMoves, WithoutAFeedrateAreARunTimeError) {
  for (const char* none : {"F0", "F10 I5190=0"}) {
    SCOPED_TRACE(none);
    begin({"1000X"});
    stop({std::string(none) + " X1", "F10 I5190=1000 X2"});
    ASSERT_EQ(host("#1HMZ"), "");
    platform::servo_ticks(5);
    ASSERT_EQ(host("&1R"), "");
    platform::servo_ticks(ticks_of(100));
    EXPECT_FALSE(run_is_running(0));
    EXPECT_EQ(cs().error, RUN_TIME_FEEDRATE);
    expect_at({0});
  }
}

// What a forward program rounds is no other way: the time stays as it is, to its last bit.
TEST_F(WaitingMoves, KeepTheirTimesWhenAForwardProgramRounds) {
  for (const char* line : {"X3", "CIRCLE1 X1 Y0 I1 J0"})
    for (const bool rounds : {true, false}) {
      SCOPED_TRACE(line);
      begin({"1000X", "1000Y"});
      kinematic({"I", "I"});
      stop({line, "LINEAR X8"});
      const std::int64_t time = path_of(&paths[0], 0)->time;
      ASSERT_EQ(host(rounds ? "P10=0.000000001" : "P10=0.001"), "");
      ASSERT_EQ(host("&1R"), "");
      for (int i = 0; i < 20 && !segment_is_under_way(0); ++i) platform::servo_ticks(1);
      ASSERT_TRUE(segment_is_under_way(0));
      EXPECT_EQ(path_of(&paths[0], 0)->time == time, rounds);
    }
}

// A rotary axis goes the way from where it is now, not to the turn that its target was in.
TEST_F(WaitingMoves, TurnTheWayFromWhereTheyAre) {
  const struct {
    const char* turn;
    Lines lines;
    double end;
  } programs[] = {{"4000", {"A2.5"}, -1500},
                  {"4000", {"A2.5", "A1"}, -3000},
                  {"4000", {"A2.5", "INC A2"}, 500},
                  {"4000", {"INC A1", "ABS A0.5"}, 500},
                  {"4000", {"INC A3"}, 3000},
                  {"-4000", {"A-0.5"}, -500},
                  {"-4000", {"A0.5"}, 500},
                  {"-4000", {"A-0.5", "A1"}, 1000},
                  {"-4000", {"A1.005", "A0.5"}, 4500},
                  {"0", {"A2.5", "A1"}, 1000}};
  for (const auto& p : programs) {
    SCOPED_TRACE(std::string(p.turn) + " " + p.lines.front() + " " + p.lines.back());
    begin({"1000A"});
    ASSERT_EQ(host(std::string("I128=160 I127=") + p.turn), "");
    stop(p.lines, "A1");
    ASSERT_EQ(host("#1HMZ"), "");
    platform::servo_ticks(5);
    go_on(10);
    expect_at({p.end});
  }
}

// Corners between them are judged by the ways that they go now: a reversal that has come is none to blend, one that has
// gone is.
TEST_F(WaitingMoves, BlendByTheWaysThatTheyGo) {
  begin({"1000X"});
  ASSERT_EQ(host("I5183=-0.5"), "");
  stop({"X0.5", "X0.2"});
  ASSERT_EQ(host("#1HMZ"), "");
  platform::servo_ticks(5);
  double farthest = 0;
  run([&](double) { farthest = std::max(farthest, at(1)); }, "&1R");
  EXPECT_EQ(farthest, 500);
  expect_at({200});

  begin({"1000X"});
  ASSERT_EQ(host("I5183=-0.5 I5182=50"), "");
  stop({"X0.5", "X0.8"});
  ASSERT_EQ(host("#1HMZ"), "");
  platform::servo_ticks(5);
  const Spline x([&](double t) { return 10 * (risen(t, 20, 0) - risen(t - 80, 20, 0)); }, 100, 5);
  double worst = 0;
  run([&](double t) { worst = std::max(worst, std::abs(at(1) - x.at(t))); }, "&1R");
  EXPECT_LE(worst, 10 / kUnit);
  expect_at({800});

  begin({"1000X"});
  ASSERT_EQ(host("I5183=-0.5 I5192=1"), "") << "nothing blends";
  stop({"X0.5", "X0.8"});
  ASSERT_EQ(host("#1HMZ"), "");
  platform::servo_ticks(5);
  EXPECT_NEAR(run([](double) {}, "&1R"), 50 + 30 + 2 * (20 + 10), 6);
  expect_at({800});
}

// The arc keeps its shape, in its plane (X goes to Z about -Y); what its end is beside that goes evenly.
TEST_F(WaitingMoves, ArcsEndAtTheirEnds) {
  constexpr double kTolerance = 4 / kUnit + 380 * 4e-6 * 16;  // the time to 4e-6 of 380 ms, at 16 counts/ms
  for (const char* arc :
       {"NORMAL J-1 CIRCLE1 X3 Z0 I1 K0", "NORMAL J-1 CIRCLE1 X3 R1", "NORMAL J-1 CIRCLE1 X3 Z0 R1"}) {
    for (const bool by_program : {false, true}) {
      SCOPED_TRACE(std::string(arc) + (by_program ? " I" : ""));
      begin({"1000X", "1000Y", "1000Z"});
      if (by_program) kinematic({"I", "1000Y", "I"});
      stop({arc, "LINEAR X4"});
      ASSERT_EQ(host("#1HMZ"), "");
      platform::servo_ticks(5);
      const double line = 100, turn = 100 * length_of([](double u) {  // ms
                                        return std::pair{u - std::cos(kPi * u), -std::sin(kPi * u)};
                                      });
      const auto made = [](double t, double time) { return (risen(t, 20, 0) - risen(t - time, 20, 0)) / time; };
      const auto x = [&](double t) {
        return 1000 * (1 - std::cos(kPi * made(t, turn)) + made(t, turn) + made(t - turn, line));
      };
      const auto z = [&](double t) { return -1000 * std::sin(kPi * made(t, turn)); };
      const Spline spline_x(x, turn + line + 20, 5), spline_z(z, turn + line + 20, 5);
      run(
          [&](double t) {
            ASSERT_NEAR(at(1), spline_x.at(t), kTolerance) << t;
            ASSERT_NEAR(at(3), spline_z.at(t), kTolerance) << t;
          },
          "&1R");
      expect_at({4000, 0, 0});
    }
  }
}

// A matrix that turns by 90 degrees: what the program calls X is Y of the motors.
TEST_F(WaitingMoves, GoToPlacesOfAMatrix) {
  for (const bool absolute : {true, false}) {
    begin({"1000X", "1000Y"});
    ASSERT_EQ(host("DELETE GATHER"), "");
    ASSERT_EQ(host("DEFINE TBUF 1"), "");
    ASSERT_EQ(host("Q1=0 Q2=1 Q3=0 Q4=-1 Q5=0 Q6=0 Q7=0 Q8=0 Q9=1"), "");
    stop({std::string("TSEL1 AROT1 ") + (absolute ? "ABS X3 Y-1" : "INC X3 Y0"), "Y-2"});
    ASSERT_EQ(host("#2HMZ"), "");
    motors[1].trajectory = motors[1].of_system = 500 * 3072;
    platform::servo_ticks(5);
    ASSERT_EQ(host("&1R"), "");
    platform::servo_ticks(ticks_of(1500));
    expect_at(absolute ? std::vector<double>{2000, 3000} : std::vector<double>{3000, 3500});
  }
}

// The forward program has an error of its own, 0.4: absolute places are places all the same, arcs too.
TEST_F(WaitingMoves, GoToTheirPlacesThroughAForwardProgramThatErrs) {
  const struct {
    Lines lines;
    std::vector<double> ends;
  } programs[] = {{{"X3", "X8"}, {8000, 0}},
                  {{"INC X2", "X5"}, {8400, 0}},
                  {{"INC X2", "ABS X8"}, {8000, 0}},
                  {{"CIRCLE1 X3 Y0 R1", "LINEAR X8 Y1"}, {8000, 1000}},
                  {{"CIRCLE2 X3 Y2 I0 J2", "LINEAR X8 Y1"}, {8000, 1000}}};
  for (const auto& p : programs) {
    SCOPED_TRACE(p.lines.front() + " " + p.lines.back());
    begin({"1000X", "1000Y"});
    kinematic({"I", "I"});
    stop(p.lines);
    ASSERT_EQ(host("P10=0.4"), "");
    ASSERT_EQ(host("&1R"), "");
    platform::servo_ticks(ticks_of(3000));
    ASSERT_FALSE(run_is_running(0));
    EXPECT_EQ(cs().error, RUN_TIME_NONE);
    for (unsigned i = 0; i < 2; ++i) EXPECT_NEAR(at(i + 1), p.ends[i], 2 / kUnit);
  }
}

// An arc that leaves a part of the way to its end in its own plane takes the time of the whole curve by F. Half a turn
// about (1, 0) from the start at 0, and a spiral; what is left goes along the chord, square to it, out of the plane.
TEST_F(WaitingMoves, ArcsTakeTheTimeOfTheirCurve) {
  const struct {
    const char *line, *home;
    double radius, growth, x, y, z;  // z: out of the plane
    double turn = 0.5;
  } cases[] = {
      {"CIRCLE1 X3 Y0 I1 J0", "#1HMZ", 1, 0, 1, 0, 0},    {"CIRCLE2 X3 Y0 I1 J0", "#1HMZ", 1, 0, 1, 0, 0},
      {"CIRCLE1 X4 Y0 I1 J0", "#1HMZ", 1, 1, 1, 0, 0},    {"CIRCLE1 X3 Y0 I1 J0", "#2HMZ", 1, 0, 0, -2, 0},
      {"CIRCLE1 X3 Y0 Z2 I1 J0", "#1HMZ", 1, 0, 1, 0, 2}, {"CIRCLE1 X1 Y0 I.25 J0", "#1HMZ", .25, 0, 1, 0, 0, 1}};
  for (const auto& c : cases) {
    SCOPED_TRACE(std::string(c.line) + " " + c.home);
    begin({"1000X", "1000Y", "1000Z"});
    stop({c.line, "LINEAR X8"});
    ASSERT_EQ(host(c.home), "");
    motors[1].trajectory = motors[1].of_system = std::llround(-c.y * 1000 * kUnit);
    platform::servo_ticks(5);
    const double sense = std::string(c.line).find("CIRCLE2") == 0 ? -1 : 1, angle = 2 * kPi * c.turn;
    const auto place = [&](double u) {
      const double radius = c.radius + c.growth * u;
      return std::pair{-radius * std::cos(angle * u) + c.x * u, sense * radius * std::sin(angle * u) + c.y * u};
    };
    ASSERT_EQ(host("&1R"), "");
    for (int i = 0; i < 20 && !segment_is_under_way(0); ++i) platform::servo_ticks(1);
    ASSERT_TRUE(segment_is_under_way(0));
    const double time = std::hypot(length_of(place), c.z) * 100;  // ms at 10 a s
    EXPECT_NEAR(static_cast<double>(path_of(&paths[0], 0)->time) / 4294967296.0, time, 1e-5 * time);
    for (int i = 0; i < 2000 && run_is_running(0); ++i) platform::servo_ticks(3);
    EXPECT_EQ(motors[0].trajectory, 8000 * 3072);
  }
}

// Moves without a way, which a forward program gives one by rounding, make no corner, whichever axes it rounds and
// whatever else has changed: nor with each other. `sharp`: by a way of 0.1 they do.
TEST_F(WaitingMoves, RoundingMakesNoCornerOfAMoveWithoutAWay) {
  const struct {
    Lines lines;
    std::vector<bool> sharp;  // behind the first, the second, the third
  } programs[] = {{{"TM50 X1", "Y2 F10", "X1"}, {true, false}},
                  {{"TM50 X1 Y0", "Y2 F10", "X1"}, {true, false}},
                  {{"TM50 X1", "Y0", "X3", "X4"}, {true, true, false}},
                  {{"TM50 X1", "X1 Y0", "Y2 F10"}, {true, true}},
                  {{"INC X2", "ABS TM50 X3"}, {true}}};  // that with a way is before it
  for (const auto& p : programs)
    for (const char* off :
         {"P10=0.000000001 P11=0.000000001", "P10=0-0.000000001 P11=0.000000001", "P10=0.1 P11=0.1"}) {
      SCOPED_TRACE(p.lines[0] + " " + p.lines[1] + " " + off);
      const bool rounds = std::string(off) != "P10=0.1 P11=0.1";
      begin({"1000X", "1000Y"});
      kinematic({"I", "I"});
      ASSERT_EQ(host("I5183=0.9"), "");
      stop(p.lines);
      ASSERT_EQ(path_of(&paths[0], 0)->sharp, false);
      ASSERT_EQ(host(off), "");
      ASSERT_EQ(host("&1R"), "");
      for (int i = 0; i < 20 && !segment_is_under_way(0); ++i) platform::servo_ticks(1);
      ASSERT_TRUE(segment_is_under_way(0));
      for (unsigned i = 0; i < p.sharp.size() && i + 1 < paths[0].count; ++i) {
        EXPECT_EQ(path_of(&paths[0], i + 1)->sharp, !rounds && p.sharp[i]) << i;
        EXPECT_EQ(path_of(&paths[0], i + 1)->joins, rounds || !p.sharp[i]) << i;
      }
    }
}

// A move without a way behind one that has changed by more than rounding: X is rounded, Y 0.1 off.
TEST_F(WaitingMoves, RoundingMakesNoCornerBehindAMoveThatHasChanged) {
  begin({"1000X", "1000Y"});
  kinematic({"I", "I"});
  ASSERT_EQ(host("I5183=0.9"), "");
  stop({"Y2", "TM50 X1", "F10 X3"});
  ASSERT_EQ(host("P10=0.000000001 P11=0.1"), "");
  ASSERT_EQ(host("&1R"), "");
  for (int i = 0; i < 20 && !segment_is_under_way(0); ++i) platform::servo_ticks(1);
  ASSERT_TRUE(segment_is_under_way(0));
  EXPECT_NEAR(path_of(&paths[0], 0)->delta[AXIS_Y], 1.9, 1e-9);
  for (unsigned i = 1; i < paths[0].count; ++i) EXPECT_FALSE(path_of(&paths[0], i)->sharp) << i;
}

// A full circle has a length though it ends where it begins: 1e-7 are less than 2^-20 of its radius, and more than that
// of the line behind it. Their corner, which is sharp by now, is judged by what counts as a change alone.
TEST_F(WaitingMoves, AFullCircleIsAsLongAsItsRadius) {
  for (const bool changes : {false, true}) {
    begin({"1000X", "1000Y"});
    kinematic({"I", "I"});
    stop({"CIRCLE1 X1 Y0 I1 J0", "LINEAR X1.01", "X8"});
    ASSERT_EQ(host("I5183=0.9"), "");
    ASSERT_EQ(host(changes ? "P10=0.00001" : "P10=0.0000001"), "");
    ASSERT_EQ(host("&1R"), "");
    for (int i = 0; i < 20 && !segment_is_under_way(0); ++i) platform::servo_ticks(1);
    ASSERT_TRUE(segment_is_under_way(0));
    EXPECT_EQ(path_of(&paths[0], 1)->sharp, changes);
  }
}

// A corner between two moves that go their ways as before stays as it was judged.
TEST_F(WaitingMoves, OtherCornersStayAsTheyAre) {
  for (const bool sharp : {true, false}) {
    begin({"1000X", "1000Y"});
    ASSERT_EQ(host(sharp ? "I5183=0" : "I5183=0.9"), "");
    stop({"X3", "INC Y2", "X2"});
    for (unsigned i = 1; i < 3; ++i) ASSERT_EQ(path_of(&paths[0], i)->sharp, !sharp);
    ASSERT_EQ(host(sharp ? "I5183=0.9" : "I5183=0"), "");
    ASSERT_EQ(host("#1HMZ"), "");
    platform::servo_ticks(5);
    ASSERT_EQ(host("&1R"), "");
    for (int i = 0; i < 20 && !segment_is_under_way(0); ++i) platform::servo_ticks(1);
    ASSERT_TRUE(segment_is_under_way(0));
    EXPECT_EQ(path_of(&paths[0], 1)->sharp, sharp) << "behind the move that has become longer";
    EXPECT_EQ(path_of(&paths[0], 2)->sharp, !sharp) << "behind one by a distance";
  }
}

}  // namespace
