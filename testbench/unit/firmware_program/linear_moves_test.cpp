// LINEAR moves of motors (motion:5.2): where they are at each servo interrupt, blending, limits, exact ends.
#include "testbench/unit/firmware_program/moving_motors.h"

extern "C" {
#include "firmware/motion/place.h"
#include "firmware/motion/plan.h"
#include "firmware/motion/system_path.h"
}

namespace {

using namespace moving_motors;

class LinearMoves : public MovingMotors {};

TEST_F(LinearMoves, OneMoveFollowsItsProfile) {
  struct Case {
    const char* rates;
    double time, acceleration, s;
  };
  const Case cases[] = {{"TM100 TA40 TS0", 100, 40, 0},   {"TM100 TA40 TS10", 100, 40, 10},
                        {"TM100 TA40 TS20", 100, 40, 20}, {"TM100 TA0 TS30", 100, 60, 30},
                        {"TM10 TA80 TS5", 80, 80, 5},     {"F100 TA20 TS0", 30, 20, 0}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.rates);
    platform::power_up();
    fit({"1000X", "-2.5X+7"});
    store({c.rates, "X3"});
    motors[1].trajectory = static_cast<std::int64_t>(7 * kUnit);  // the axis is at 0
    const std::vector<Move> x = {{3000, c.time, c.acceleration, c.s}}, second = {{-7.5, c.time, c.acceleration, c.s}};
    auto profiles = std::vector{changes_of(x, c.acceleration), changes_of(second, c.acceleration)};
    const double begin = at(2);
    double worst = 0.0;
    const double end = run([&](double t) {
      worst = std::max(worst, std::abs(at(1) - way(profiles[0], t)));
      worst = std::max(worst, std::abs(at(2) - begin - way(profiles[1], t)));
    });
    EXPECT_LT(worst * kUnit, 3.0);
    EXPECT_EQ(motors[0].trajectory, 3000 * 3072);
    EXPECT_EQ(motors[1].trajectory, -1536);  // half a count
    EXPECT_NEAR(end, c.time + c.acceleration, kTickMs);
  }
}

// Longer and shorter accelerations than that of the move before, corners, motors that stop and start in a blend.
TEST_F(LinearMoves, BlendedMovesFollowTheirProfile) {
  fit({"1000X", "500Y", "8660X-5000Y"});
  store({"TM100 TA40 TS10 X1", "TA80 X2 Y1", "TA20 TS5 Y3", "TM150 TA60 TS30 X-1 Y3", "DELAY70", "TA10 TS0 X0 Y0"});
  const double dx[] = {1, 1, 0, -3, 0, 1}, dy[] = {0, 1, 2, 0, 0, -3};
  const double time[] = {100, 100, 100, 150, 70, 150}, ta[] = {40, 80, 20, 60, 60, 10}, ts[] = {10, 10, 5, 30, 30, 0};
  std::vector<Move> moves[3];
  for (unsigned i = 0; i < 6; ++i) {
    moves[0].push_back({1000 * dx[i], time[i], ta[i], ts[i]});
    moves[1].push_back({500 * dy[i], time[i], ta[i], ts[i]});
    moves[2].push_back({8660 * dx[i] - 5000 * dy[i], time[i], ta[i], ts[i]});
  }
  const double end = follow({changes_of(moves[0], 10), changes_of(moves[1], 10), changes_of(moves[2], 10)});
  EXPECT_NEAR(end, 20 + 100 + 100 + 100 + 150 + 70 + 150 + 5, kTickMs);
  for (unsigned motor = 0; motor < 3; ++motor) EXPECT_EQ(motors[motor].trajectory, 0);
}

// At each stop the commanded position is the target, whatever came before.
TEST_F(LinearMoves, EndsAreExact) {
  fit({"1000X", "333.25Y"});
  Lines lines = {"TM20 TA7 TS2"};
  std::vector<std::int64_t> x, y;
  std::uint32_t seed = 1;
  const auto random = [&] { return (seed = seed * 1664525u + 1013904223u) >> 8 & 0xFFFF; };
  for (int i = 0; i < 40; ++i) {
    const int a = static_cast<int>(random()) - 32768, b = static_cast<int>(random()) - 32768;
    lines.push_back("X" + std::to_string(a / 1000) + "Y" + std::to_string(b));
    if (i % 4 == 3) {
      lines.push_back("DWELL3");
      x.push_back(a / 1000 * 1000 * 3072);
      y.push_back(static_cast<std::int64_t>(b) * 1023744);
    }
  }
  store(lines);
  std::size_t stops = 0;
  bool dwelt = false;
  run([&](double) {
    const bool dwells = cs().active && cs().moves[cs().executing].kind == MOVE_DWELL;
    if (dwells && !dwelt) {
      ASSERT_LT(stops, x.size());
      EXPECT_EQ(motors[0].trajectory, x[stops]);
      EXPECT_EQ(motors[1].trajectory, y[stops]);
      ++stops;
    }
    dwelt = dwells;
  });
  EXPECT_EQ(stops, 10u);
}

// Planned and executed without the program around them, which would take most of the time.
TEST_F(LinearMoves, AMillionIncrementalMovesOfWholeCountsDriftByNothing) {
  fit({"1000X", "Y"});
  ASSERT_EQ(host("OPEN PROG 1 CLEAR"), "");
  ASSERT_EQ(host("TM0.5 TA0 TS0 WHILE(P1=0) WAIT"), "");
  ASSERT_EQ(host("CLOSE B1R"), "");
  platform::servo_ticks(9);
  constexpr int kMoves = 1000000;
  coordinate_system& s = cs();
  for (int i = 0; i < kMoves; ++i) {
    s.pending[AXIS_X] = s.position[AXIS_X] + 0.001;
    s.pending[AXIS_Y] = s.position[AXIS_Y] + 3;
    s.pending_axes = 1u << AXIS_X | 1u << AXIS_Y;
    ASSERT_EQ(plan_line(0), RUN_TIME_NONE);
    ASSERT_TRUE(move_place(0));
    for (int tick = 0; s.next_valid; ++tick) {
      ASSERT_LT(tick, 5);
      system_path_servo();
    }
  }
  while (s.active) system_path_servo();
  EXPECT_EQ(motors[0].trajectory, std::int64_t{kMoves} * 3072);
  EXPECT_EQ(motors[1].trajectory, std::int64_t{kMoves} * 3 * 3072);
}

// Largest velocity and acceleration (counts a ms, a ms^2) of a motor, from differences over four servo interrupts.
struct Extremes {
  std::vector<double> last;
  double velocity = 0.0, acceleration = 0.0;
  void add(double position) {
    last.push_back(position);
    const std::size_t n = last.size();
    if (n < 9) return;
    const double time = 4 * kTickMs, now = (last[n - 1] - last[n - 5]) / time,
                 before = (last[n - 5] - last[n - 9]) / time;
    velocity = std::max(velocity, std::abs(now));
    acceleration = std::max(acceleration, std::abs(now - before) / time);
  }
};

// motion:5.2, its checks: 10,000 counts a unit, F10, TA200 TS0, Ixx17 = 0.25.
TEST_F(LinearMoves, AccelerationLimitStretchesTheCorner) {
  struct Case {
    const char *first, *second;
    double by1[2], by2[2], time, corner;
  };
  const double diagonal = std::sqrt(2.0);
  const Case cases[] = {{"X20", "X20 Y20", {200000, 0}, {0, 200000}, 2000, 400},
                        {"X20 Y20", "X0 Y40", {200000, 200000}, {-200000, 200000}, 2000 * diagonal, 400 * diagonal}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.second);
    platform::power_up();
    fit({"10000X", "10000Y"});
    ASSERT_EQ(host("I117=0.25 I217=0.25"), "");
    store({"F10 TA200 TS0", c.first, c.second});
    const double begin = std::abs(c.by1[0]) / c.time / 0.25, end = std::abs(c.by2[1]) / c.time / 0.25;
    std::vector<std::vector<Change>> profiles;
    for (int i = 0; i < 2; ++i)
      profiles.push_back(changes_of({{c.by1[i], c.time, begin, 0}, {c.by2[i], c.time, c.corner, 0}}, end));
    follow(profiles, 6.0);
  }
}

// Of several motors the one that needs longest tells, wherever it stands.
TEST_F(LinearMoves, TheSlowestMotorTellsTheLengthOfACorner) {
  for (const bool first : {true, false}) {
    platform::power_up();
    fit({"1000X", "1000Y"});
    ASSERT_EQ(host("I117=0.25 I217=0.25"), "");
    store({"TM1000 TA20 TS0", first ? "X20 Y10" : "X10 Y20", "X0 Y0"});  // 20 and 10 counts a ms, then back
    const double stop = 20 / 0.25, corner = 40 / 0.25;
    const auto profile = [&](double by) { return changes_of({{by, 1000, stop, 0}, {-by, 1000, corner, 0}}, stop); };
    follow({profile(first ? 20000 : 10000), profile(first ? 10000 : 20000)}, 6.0);
  }
}

// With an S-part: 40 / 0.25 + 20 in all at the corner, 20 / 0.25 + 20 at the ends.
TEST_F(LinearMoves, AnSPartLengthensAStretchedCorner) {
  fit({"1000X"});
  ASSERT_EQ(host("I117=0.25"), "");
  store({"TM1000 TA60 TS20 X20", "X0"});
  follow({changes_of({{20000, 1000, 100, 20}, {-20000, 1000, 180, 20}}, 100)}, 6.0);
}

// A blend begins behind the change before it and ends before the one behind it.
TEST_F(LinearMoves, BlendsStayWithinTheirMoves) {
  fit({"1000X"});
  store({"TM20 TA10 TS0 X0.2", "TM300 TA200 X2", "TM20 TA20 X2.1"});
  follow({changes_of({{200, 20, 10, 0}, {1800, 300, 30, 0}, {100, 20, 20, 0}}, 20)});
  platform::power_up();
  fit({"1000X"});
  store({"TM20 TA10 TS0 X0.2", "TM300 TA200 TS50 X2"});  // an S keeps its quarter
  follow({{{5, 10, 0, 10}, {25, 30, 7.5, 6 - 10}, {325, 200, 50, -6}}});
  platform::power_up();
  fit({"1000X"});
  store({"TM300 TA20 TS0 X3", "TM30 TA40 X3.1"});  // 40 ms at least: its stop leaves 20 of them
  follow({changes_of({{3000, 300, 20, 0}, {100, 40, 40, 0}}, 40)});
}

// Ixx16 makes the move longer, for all motors.
TEST_F(LinearMoves, VelocityLimitStretchesTheMove) {
  for (const char* limits : {"I216=5", "I116=10 I216=10"}) {  // Y asks for 400 ms, or X for 400 and Y for 200
    platform::power_up();
    fit({"1000X", "1000Y"});
    ASSERT_EQ(host(limits), "");
    store({"TM100 TA40 TS0", "X4 Y2"});  // 20 counts a ms
    follow({changes_of({{4000, 400, 40, 0}}, 40), changes_of({{2000, 400, 40, 0}}, 40)});
  }
}

// motion:5.2/2: at 0 neither limits; by default the move would be 125 ms long and its changes 80 ms.
TEST_F(LinearMoves, ZeroIsNoLimit) {
  fit({"1000X"});
  ASSERT_EQ(host("I116=0 I117=0"), "");
  store({"TM100 TA10 TS0", "X4"});
  follow({changes_of({{4000, 100, 10, 0}}, 10)});
}

// A short move is so slow that it could stop in itself: with v = d / Tm, Tm = v / Ixx17 + TS.
TEST_F(LinearMoves, EachMoveCanStopWithinItself) {
  fit({"1000X"});
  ASSERT_EQ(host("I117=0.1"), "");
  store({"TM10 TA10 TS5 INC", "X0.4", "X0.4", "X0.4"});
  const double time = (5 + std::sqrt(25 + 4 * 400 / 0.1)) / 2;
  follow({changes_of({{400, time, time, 5}, {400, time, 10, 5}, {400, time, 10, 5}}, time)});
}

TEST_F(LinearMoves, LimitsHoldInAnySequence) {
  std::uint32_t seed = 7;
  const auto random = [&](std::uint32_t below) { return (seed = seed * 1664525u + 1013904223u) / 65536 % below; };
  for (int round = 0; round < 6; ++round) {
    platform::power_up();
    fit({"1000X", "1000Y"});
    ASSERT_EQ(host("I116=20 I117=0.2 I216=30 I217=0.1"), "");
    Lines lines = {"F40 TS0 TA0"};
    for (int i = 0; i < 60; ++i) {
      if (random(5) == 0) lines.push_back("TA" + std::to_string(random(100)) + "TS" + std::to_string(random(40)));
      lines.push_back("X" + std::to_string(random(4)) + "Y" + std::to_string(random(3)));
    }
    store(lines);
    Extremes x, y;
    run([&](double) { x.add(at(1)), y.add(at(2)); });
    EXPECT_LE(x.velocity, 20 * 1.001) << round;
    EXPECT_LE(y.velocity, 30 * 1.001);
    EXPECT_LE(x.acceleration, 0.2 * 1.01);
    EXPECT_LE(y.acceleration, 0.1 * 1.01);
    EXPECT_GT(x.velocity, 10.0);
    EXPECT_GT(x.acceleration, 0.19);
  }
}

// Virtual axes: a blend that should have begun already lasts as long before the corner as behind it.
TEST_F(LinearMoves, ALateBlendOfVirtualAxesIsShort) {
  ASSERT_EQ(host("&1 DEF ROT 100 B0 OPEN ROT"), "");
  ASSERT_EQ(host("TM100 TA20 TS0 X1"), "");
  ASSERT_EQ(host("R"), "");
  for (int i = 0; i < 20 && !cs().active; ++i) platform::servo_ticks(1);
  platform::servo_ticks(ticks_of(90.0));
  ASSERT_EQ(host("TA100 X3"), "");  // at its best from 60 to 160 ms; now until 130 at the latest
  platform::servo_ticks(ticks_of(140.0) - ticks_of(90.0));
  ASSERT_EQ(host("A"), "");
  platform::real_time();
  EXPECT_NEAR(cs().position[AXIS_X], 1 + (ticks_of(140.0) * kTickMs - 110.0) * 2 / 100, 1e-6);
}

// Virtual axes: neither does a blend begin before the change at the beginning of its move has ended.
TEST_F(LinearMoves, ABlendOfVirtualAxesStaysWithinItsMoves) {
  store({"TM20 TA20 TS0 X1", "TM100 TA200 X3", "WHILE(P1=0) WAIT"});
  ASSERT_EQ(host("&1B1R"), "");
  for (int i = 0; i < 20 && !cs().active; ++i) platform::servo_ticks(1);
  platform::servo_ticks(ticks_of(35.0));
  ASSERT_EQ(host("A"), "");
  platform::real_time();
  // 1/20 a ms from 20 ms on, then to 1/100 until 40 ms, 20 ms about the corner at 30 ms.
  const double t = ticks_of(35.0) * kTickMs - 20.0, change = (0.01 - 0.05) / 20.0;
  EXPECT_NEAR(cs().position[AXIS_X], 0.5 + 0.05 * t + change * t * t / 2.0, 1e-6);
}

// While one is planned the servo task goes on: what comes too late is planned again, for later.
TEST_F(LinearMoves, ABlendThatIsPlannedTooLateIsPlannedAgain) {
  fit({"1000X", "1000Y"});
  ASSERT_EQ(host("&1 DEF ROT 100 B0 OPEN ROT"), "");
  ASSERT_EQ(host("TM200 TA40 TS0 X1 Y1"), "");
  ASSERT_EQ(host("R"), "");
  for (int i = 0; i < 20 && !cs().active; ++i) platform::servo_ticks(1);
  platform::servo_ticks(ticks_of(168.0));
  ASSERT_EQ(host("TA100 X2 Y2"), "");  // its blend would begin at 170 ms, the stop at 200
  unsigned pauses = 0, interrupts = 0;
  double slowest = 100.0, last = at(1);
  const auto servo = [&] {
    system_path_servo();
    if (++interrupts < ticks_of(100.0)) slowest = std::min(slowest, (at(1) - last) / kTickMs);
    last = at(1);
  };
  for (int i = 0; i < 400; ++i) {
    servo();
    platform::real_time_in_slices([&] {
      if (++pauses % 6 == 0) servo();
    });
    if (cs().placed && pauses < 1000) { EXPECT_TRUE(cs().moves[cs().executing ^ 1u].blended); }
  }
  EXPECT_GT(interrupts, ticks_of(100.0));
  EXPECT_NEAR(slowest, 5.0, 0.01) << "no stop";
}

// What takes the place of pieces comes too late once the servo task is beyond it.
TEST(PieceRing, PiecesAreReplacedUntilTheyAreOver) {
  static cubic cubics[PIECES];
  static piece_ring ring;
  piece_ring_initialize(&ring, cubics, 1);
  for (std::uint32_t i = 0; i < 3; ++i) {
    piece_set_time(piece_ring_at(&ring, i), 100);
    if (i < 2) piece_ring_add(&ring);
  }
  ASSERT_TRUE(piece_ring_advance(&ring, 60));
  EXPECT_FALSE(piece_ring_replace(&ring, 0, 50, 1)) << "10 beyond";
  EXPECT_FALSE(piece_ring_replace(&ring, 2, 50, 1)) << "has not been added";
  EXPECT_TRUE(piece_ring_replace(&ring, 0, 70, 1));
  ASSERT_TRUE(piece_ring_advance(&ring, 30));
  EXPECT_EQ(ring.executing, 2u) << "the second is passed over";
  EXPECT_EQ(ring.elapsed, 20);
  EXPECT_FALSE(piece_ring_replace(&ring, 0, 90, 0)) << "over";
  EXPECT_FALSE(piece_ring_advance(&ring, 80));
}

// firmware:1.10: the trajectory word is what the servo loop is asked to follow.
TEST_F(LinearMoves, ALineThatComesLateBlendsFromWhereItIs) {
  fit({"1000X"});
  ASSERT_EQ(host("&1 DEF ROT 100 B0 OPEN ROT"), "");
  ASSERT_EQ(host("TM200 TA40 TS0 X1"), "");
  ASSERT_EQ(host("R"), "");
  for (int i = 0; i < 20 && !cs().active; ++i) platform::servo_ticks(1);
  platform::servo_ticks(ticks_of(170.0));
  ASSERT_EQ(host("TA100 X2"), "");  // its blend should have begun at 170 ms
  Extremes x;
  for (int i = 0; i < 2000 && cs().active; ++i) {
    x.add(at(1));
    platform::servo_ticks(1);
  }
  EXPECT_EQ(motors[0].trajectory, 2000 * 3072);
  EXPECT_LE(x.velocity, 5.001);
  EXPECT_LE(x.acceleration, 5.0 / 100.0 * 1.01) << "same velocity: only the stop accelerates";
}

}  // namespace
