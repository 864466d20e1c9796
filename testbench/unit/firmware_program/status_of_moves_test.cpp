// What `??` and `?` tell of programs that move motors, bit by bit: firmware:5.2 to firmware:5.7.
#include "testbench/unit/firmware_program/moving_motors.h"

extern "C" {
#include "firmware/base/dpram.h"
#include "firmware/motion/jog.h"
#include "firmware/motion/motor_target.h"
#include "firmware/motion/protection.h"
#include "firmware/run/run_control.h"
}

namespace {

using namespace moving_motors;

class StatusOfMoves : public MovingMotors {
 protected:
  static unsigned long word(unsigned number, const std::string& cs = "1") {
    return std::stoul(host("&" + cs + "??").substr(6 * (number - 1), 6), nullptr, 16);
  }
  static bool bit(unsigned number, unsigned position, const std::string& cs = "1") {
    return (word(number, cs) >> position & 1u) != 0;
  }
  static bool of_motor(unsigned motor, unsigned position) {
    return (std::stoul(host("#" + std::to_string(motor) + "?").substr(0, 6), nullptr, 16) >> position & 1u) != 0;
  }
  static void ticks(double ms) { platform::servo_ticks(ticks_of(ms)); }
};

// Bits 4, 1, 0 of word 2.
TEST_F(StatusOfMoves, TheMode) {
  const struct {
    const char* line;
    unsigned bits;
  } modes[] = {{"LINEAR", 0x00},  {"RAPID", 0x02},   {"SPLINE1", 0x11}, {"SPLINE2", 0x11},
               {"CIRCLE1", 0x01}, {"CIRCLE2", 0x03}, {"PVT20", 0x12},   {"LINEAR", 0x00}};
  for (const auto& mode : modes) {
    store({mode.line, "DWELL100"});
    ASSERT_EQ(host("&1B1R"), "");
    platform::servo_ticks(20);
    EXPECT_EQ(word(2) & 0x13u, mode.bits) << mode.line;
    EXPECT_EQ(word(2) & 0x2Cu, 0u) << mode.line;
    platform::servo_ticks(400);
  }
}

// A piece has the motors that it moves and no others, and only for those it has an end (D:$C7 of motor 1).
TEST_F(StatusOfMoves, APieceIsOfTheMotorsThatItMoves) {
  fit({"1000X", "1000Y", "1000Z"});
  ASSERT_EQ(host("#1->0"), "");  // 2 and 3 are left
  const struct {
    const char *mode, *line;
    std::uint32_t motors;
  } moves[] = {{"LINEAR TM100 TA20 TS5", "Y1 Z0", 0b010}, {"LINEAR TM100 TA20 TS5", "Z1", 0b100},
               {"LINEAR TM100 TA20 TS5", "Y1 Z1", 0b110}, {"PVT100", "Y1:5 Z1:5", 0b110},
               {"SPLINE1 TM100", "Y1 Z1", 0b110},         {"LINEAR", "DELAY100", 0}};
  for (const auto& move : moves) {
    SCOPED_TRACE(std::string(move.mode) + " " + move.line);
    for (unsigned motor = 0; motor < 3; ++motor) motors[motor].trajectory = 77 * motor;
    store({"INC", move.mode, move.line, "DWELL10"});
    ASSERT_EQ(host("&1B1R"), "");
    for (int i = 0; i < 200 && !cs().active; ++i) platform::servo_ticks(1);
    platform::servo_ticks(5);
    ASSERT_TRUE(cs().active);
    piece_ring& ring = cs().ring;
    ASSERT_FALSE(piece_ring_is_empty(&ring));
    const std::uint32_t of = piece_ring_at(&ring, ring.executing)->move;
    for (std::uint32_t n = ring.executing; n != ring.added && piece_ring_at(&ring, n)->move == of; ++n)
      EXPECT_EQ(piece_ring_at(&ring, n)->motors, move.motors) << n - ring.executing;
    for (unsigned motor = 0; motor < 3; ++motor)
      EXPECT_EQ(motor_target(motor) != motors[motor].trajectory, (move.motors >> motor & 1u) != 0) << motor;
    EXPECT_EQ(motors[0].trajectory, 0);
    ticks(400);
    ASSERT_FALSE(run_is_running(0));
  }
}

// A motor that its program has moved, and that is of no system since, has nothing to do with what &1 executes.
TEST_F(StatusOfMoves, AMotorThatIsOfNoSystemAnyMoreIsNotMoved) {
  fit({"1000X", "1000Y"});
  ASSERT_EQ(host("I128=160 I188=0 I228=160 I288=0"), "");
  store({"LINEAR TM100 TA20 TS0 X1 Y1"});
  ASSERT_EQ(host("&1B1R"), "");
  ticks(300);
  ASSERT_EQ(host("#2->0"), "");
  store({"LINEAR TM500 TA20 TS0 X2"});
  ASSERT_EQ(host("&1B1R"), "");
  ticks(200);
  EXPECT_TRUE(of_motor(1, 17));
  EXPECT_FALSE(of_motor(2, 17)) << "move timer";
  motors[1].actual = motors[1].closed_at = motors[1].commanded;
  protection_pass();
  EXPECT_TRUE(motors[1].found.in_position);
  EXPECT_FALSE(motors[0].found.in_position);
}

// Bit 0 of word 1: moves of 500 ms. What stands behind one is read when that begins.
TEST_F(StatusOfMoves, RunningEndsWithTheCalculationOfTheLastMove) {
  store({"LINEAR INC TA100 TS0 TM500", "X1", "X1"});
  ASSERT_EQ(host("&1B1R"), "");
  ticks(300);
  EXPECT_TRUE(bit(1, 0)) << "the second is calculated, the end is not reached";
  ticks(400);
  EXPECT_FALSE(bit(1, 0)) << "the second executes, nothing is left to calculate";
  EXPECT_FALSE(bit(2, 17)) << "and not executed";
  EXPECT_EQ(host("B1"), "ERR001");
  ticks(1200);
  EXPECT_FALSE(bit(1, 0));
  EXPECT_EQ(host("B1"), "");
}

// Bit 14 of word 2, of a motor, in segments and without.
TEST_F(StatusOfMoves, StopAtTheEndOfABlock) {
  fit({"1000X"});
  for (const char* i5113 : {"0", "10"}) {
    store({"LINEAR INC TA20 TS0 TM300", "X1", "X1", "X1", "X1", "X1"});
    ASSERT_EQ(host(std::string("I5113=") + i5113 + " &1B1R"), "");
    ticks(100);
    EXPECT_FALSE(bit(2, 14)) << i5113;
    ASSERT_EQ(host("/"), "");
    EXPECT_TRUE(bit(2, 14)) << i5113;
    ticks(1200);
    EXPECT_FALSE(run_is_running(0)) << i5113;
    EXPECT_TRUE(bit(2, 14)) << "stopped by it: " << i5113;
    ASSERT_EQ(host("R"), "");
    EXPECT_FALSE(bit(2, 14)) << i5113;
    ticks(100);
    ASSERT_EQ(host("Q"), "");
    EXPECT_FALSE(bit(2, 14)) << i5113;
    ticks(1200);
    ASSERT_EQ(host("A"), "");
    ticks(200);
  }
}

// Bits 23 to 6 of word 1: a pair an axis, A lowest; then vectors, time.
TEST_F(StatusOfMoves, AxesAndTimes) {
  EXPECT_EQ(word(1), 0xA80020u);
  const char* axes = "ABCUVWXYZ";
  for (unsigned axis = 0; axis < 9; ++axis) {
    const std::string name(1, axes[axis]);
    store({"ABS INC(" + name + ") FRAX(" + name + ")", "DWELL10"});
    ASSERT_EQ(host("&1B1R"), "");
    platform::servo_ticks(60);
    EXPECT_EQ(word(1), 0x20u | 3u << (6 + 2 * axis)) << name;
  }
  store({"ABS(R) TM100", "DWELL50", "INC(R) F5", "DWELL50", "TM100"});
  ASSERT_EQ(host("&1B1R"), "");
  platform::servo_ticks(60);
  EXPECT_EQ(word(1) & 0x2Du, 0x09u) << "vectors absolute, by time, runs";
  platform::servo_ticks(120);
  EXPECT_EQ(word(1) & 0x2Du, 0x21u) << "incremental, by feedrate";
  platform::servo_ticks(200);
  EXPECT_EQ(word(1) & 0x2Du, 0x28u);
  ASSERT_EQ(host("B1S"), "");
  EXPECT_EQ(word(1) & 0x13u, 0x03u) << "a step: not continuous";
  platform::servo_ticks(120);
  EXPECT_EQ(word(1) & 0x13u, 0x00u) << "it is done";
  store({"WHILE(1=1)", "DWELL20", "ENDWHILE"});
  ASSERT_EQ(host("B1R"), "");
  platform::servo_ticks(20);
  EXPECT_EQ(word(1) & 0x13u, 0x11u);
  ASSERT_EQ(host("Q"), "");
  EXPECT_EQ(word(1) & 0x03u, 0x03u) << "told to quit";
  platform::servo_ticks(120);
  EXPECT_EQ(word(1) & 0x13u, 0x00u);
}

// Bits 17 and 12 of word 2, 15 of the motors', 2 of word 1.
TEST_F(StatusOfMoves, DwellsBlendsAndInPosition) {
  fit({"1000X"});
  ASSERT_EQ(host("#2->0"), "");
  store({"TM50 TA20 TS0 X1", "X2", "DWELL50", "X3"});
  ASSERT_EQ(host("&1B1R"), "");
  ticks(40);
  EXPECT_FALSE(bit(2, 17)) << "it moves";
  EXPECT_FALSE(bit(1, 2)) << "from rest";
  EXPECT_FALSE(of_motor(1, 15));
  ticks(40);
  EXPECT_TRUE(bit(1, 2)) << "the second began blended";
  EXPECT_TRUE(bit(2, 12)) << "the dwell waits";
  EXPECT_FALSE(of_motor(1, 15)) << "and does not execute";
  ticks(60);
  EXPECT_TRUE(bit(2, 12)) << "it executes";
  EXPECT_TRUE(of_motor(1, 15));
  EXPECT_FALSE(of_motor(3, 15)) << "in no system";
  EXPECT_FALSE(bit(2, 17));
  ticks(50);
  EXPECT_FALSE(bit(2, 12));
  EXPECT_FALSE(of_motor(1, 15));
  ticks(200);
  EXPECT_EQ(word(2) & 0x421080u, 0u) << "no in position: what is behind the loop has not been told so";
  motors[0].found.in_position = true;
  EXPECT_TRUE(bit(2, 17));
  ASSERT_EQ(host("#1->0"), "");
  EXPECT_TRUE(bit(2, 17)) << "virtual axes that stand";
}

// Definitions that no SAVE has kept are gone behind a reset: a system without motors is in position.
TEST_F(StatusOfMoves, AResetLeavesASystemNoMotors) {
  fit({"1000X"});
  EXPECT_FALSE(bit(2, 17));
  platform::reset("$$$");
  EXPECT_TRUE(bit(2, 17));
}

// What has been last shows no more.
TEST_F(StatusOfMoves, NothingStaysBehindTheEnd) {
  fit({"1000X"});
  for (const Lines& lines : {Lines{"TM50 TA20 TS0 X1", "X2"}, Lines{"DWELL20"}}) {
    store(lines);
    run();
    ticks(20);
    EXPECT_FALSE(bit(1, 2)) << lines.back();
    EXPECT_FALSE(bit(2, 12)) << lines.back();
    EXPECT_FALSE(of_motor(1, 15)) << lines.back();
  }
}

// Bits 6 and 5 of word 3: the wait for in position (Isx81) is no pause, the pause of Isx82 is; neither is a sharp
// corner.
TEST_F(StatusOfMoves, WaitsAndPausesBetweenMoves) {
  fit({"1000X"});
  ASSERT_EQ(host("I5192=1 I5181=1000 I5182=60 I128=0"), "");
  store({"TM30 TA20 TS0 X1", "X2"});
  ASSERT_EQ(host("B1R"), "");
  ticks(90);
  EXPECT_EQ(motors[0].trajectory, 3072 * 1000) << "waits";
  EXPECT_EQ(word(3) & 0x60u, 0u);
  ASSERT_EQ(host("I128=8000000"), "");  // it is in position whatever the loop does
  ticks(20);
  EXPECT_EQ(motors[0].trajectory, 3072 * 1000) << "pauses";
  EXPECT_EQ(word(3) & 0x60u, 0x20u);
  ticks(80);
  EXPECT_EQ(word(3) & 0x60u, 0u);
  EXPECT_GT(motors[0].trajectory, 3072 * 1000);
}

// Bit 0 of word 3 is for PMATCH of a program that runs; bit 16 of word 2 for the buffer of its own system.
TEST_F(StatusOfMoves, MatchesAndFullBuffers) {
  fit({"1000X"});
  ASSERT_EQ(host("PMATCH"), "");
  EXPECT_FALSE(bit(3, 0));
  ticks(10);
  ASSERT_EQ(host("&2 DEF ROT 20 B0 OPEN ROT"), "");
  for (int i = 0; i < 40; ++i) (void)host("X1.125");
  EXPECT_TRUE(bit(2, 16, "2"));
  EXPECT_FALSE(bit(2, 16, "1"));
  ASSERT_EQ(host("CLOSE OPEN FORWARD"), "");
  EXPECT_EQ(std::stoul(host("???").substr(6), nullptr, 16) & 0xC000u, 0x8000u);
  ASSERT_EQ(host("CLOSE OPEN INVERSE"), "");
  EXPECT_EQ(std::stoul(host("???").substr(6), nullptr, 16) & 0xC000u, 0x4000u);
  ASSERT_EQ(host("CLOSE"), "");
}

// Bits 20, 19, 18 of word 2, of any motor of the system and of no other.
TEST_F(StatusOfMoves, WhatTheMotorsHave) {
  fit({"1000X", "1000Y"});
  ASSERT_EQ(host("&2#5->X"), "");
  EXPECT_EQ(word(2) & 0x1C0000u, 0u);
  for (const unsigned motor : {0u, 1u, 4u, 7u}) {
    const unsigned first = motor < 2 ? 1 : 0, second = motor == 4 ? 1 : 0;
    auto& found = motors[motor].found;
    found.amplifier_fault = true;
    EXPECT_EQ(word(2) >> 18 & 7u, 4u * first) << motor;
    EXPECT_EQ(word(2, "2") >> 18 & 7u, 4u * second) << motor;
    found.amplifier_fault = false;
    found.fatal_error = true;
    EXPECT_EQ(word(2) >> 18 & 7u, 2u * first) << motor;
    EXPECT_EQ(word(2, "2") >> 18 & 7u, 2u * second) << motor;
    found.fatal_error = false;
    found.warning_error = true;
    EXPECT_EQ(word(2) >> 18 & 7u, 1u * first) << motor;
    found.warning_error = false;
    found.on_desired_limit = true;
    EXPECT_EQ(bit(3, 1), first == 1) << motor;
    EXPECT_EQ(bit(3, 1, "2"), second == 1) << motor;
    found.on_desired_limit = false;
  }
}

// Bit 14 of the motors that the program moves: run-time error 9, until the next start. Bit 22 of word 2 has any error.
TEST_F(StatusOfMoves, DataThatCameTooLate) {
  fit({"1000X", "1000Y"});
  ASSERT_EQ(host("I115=1 I215=1 &1 DEF ROT 100 B0 OPEN ROT"), "");
  ASSERT_EQ(host("PVT20 X.1:20"), "");
  ASSERT_EQ(host("R"), "");
  EXPECT_FALSE(of_motor(1, 14));
  ticks(80);
  ASSERT_EQ(host("RY$2014"), "9");
  EXPECT_TRUE(of_motor(1, 14));
  EXPECT_TRUE(of_motor(2, 14)) << "of the same program";
  EXPECT_FALSE(of_motor(3, 14));
  EXPECT_TRUE(bit(2, 22));
  ASSERT_EQ(host("CLOSE"), "");
  ASSERT_EQ(host("R"), "");
  EXPECT_FALSE(of_motor(1, 14));
  EXPECT_FALSE(bit(2, 22));
  ticks(50);
  ASSERT_EQ(host("Q"), "");
  ticks(20);
  store({"CALL99"}, 7);
  ASSERT_EQ(host("B7"), "");
  ASSERT_EQ(host("R"), "");
  ticks(20);
  ASSERT_EQ(host("RY$2014"), "2");
  EXPECT_TRUE(bit(2, 22));
  EXPECT_FALSE(bit(3, 3)) << "that is for arcs";
  EXPECT_FALSE(of_motor(1, 14)) << "another error";
}

// Bit 2 of word 3: refused with ERR017, until one is not, the pointer is moved, or an abort.
TEST_F(StatusOfMoves, AStartThatWasRefused) {
  fit({"1000X"});
  store({"TM50 TA20 TS0 X1", "X2", "X3", "X4"});
  for (const char* end : {"R", "B1", "A"}) {
    ASSERT_EQ(host("B1R"), "");
    ticks(30);
    ASSERT_EQ(host("Q"), "");
    ticks(150);
    const std::int64_t stopped = motors[0].trajectory;
    ASSERT_TRUE(jog_to(0, stopped + 3072 * 20));
    ticks(500);
    EXPECT_FALSE(bit(3, 2)) << end;
    ASSERT_EQ(host("S"), "ERR017");
    EXPECT_TRUE(bit(3, 2)) << end;
    ASSERT_TRUE(jog_to(0, stopped));
    ticks(500);
    EXPECT_TRUE(bit(3, 2)) << end;
    ASSERT_EQ(host(end), "");
    EXPECT_FALSE(bit(3, 2)) << end;
    ticks(300);
    ASSERT_EQ(host("A"), "");
    ticks(300);
  }
}

// Bits 23 and 7 of word 2: segments, in lookahead.
TEST_F(StatusOfMoves, SegmentsAndLookahead) {
  fit({"1000X"});
  ASSERT_EQ(host("&1DEFINE LOOKAHEAD 60,10 I117=1"), "");
  store({"TM100 TA20 TS0 X1", "DWELL20"});
  for (const int isx13 : {0, 5}) {
    for (const int isx20 : {0, 20}) {
      ASSERT_EQ(host("I5113=" + std::to_string(isx13) + " I5120=" + std::to_string(isx20) + " B1R"), "");
      ticks(90);
      EXPECT_EQ(bit(2, 7), isx13 != 0) << isx13 << " " << isx20;
      EXPECT_EQ(bit(2, 23), isx13 != 0 && isx20 != 0) << isx13 << " " << isx20;
      ticks(300);
      EXPECT_FALSE(bit(2, 7));
      EXPECT_FALSE(bit(2, 23));
      ASSERT_EQ(host("A"), "");
      ticks(50);
    }
  }
}

// host-bus:6.5/26, 27: what does not accelerate has the time that it was given, whatever was in its place before; of
// RAPID and segments none is told.
TEST_F(StatusOfMoves, TimesLeftOfWhatIsNoLinearMove) {
  const struct {
    const char* line;
    move_kind kind;
    double ms;
  } cases[] = {{"DWELL500", MOVE_DWELL, 500}, {"PVT300 X4:0", MOVE_PVT, 300}, {"RAPID X400", MOVE_OWN, 0}};
  const auto left = [](std::uint32_t item) {
    platform::background(2);
    return static_cast<std::int32_t>(dpram_read_item(DPRAM_CS_BLOCKS + item));
  };
  fit({"1000X"});
  dpram_write(DPRAM_BACKGROUND_COUNT, 1);
  ASSERT_EQ(host("I50=1 I49=1"), "");
  const auto expect = [&](double ms, const char* line) {
    EXPECT_NEAR(left(DPRAM_CS_MOVE_TIME_LEFT), ms, 1) << line;
    EXPECT_EQ(left(DPRAM_CS_ACCELERATION_TIME_LEFT), 0) << line;
  };
  for (const auto& c : cases) {
    store({"LINEAR TA100 TS0 TM200 X1", "X2", "X3", c.line});
    ASSERT_EQ(host("&1B1R"), "");
    for (int i = 0; i < 5000 && !(cs().active && cs().moves[cs().executing].kind == c.kind); ++i)
      platform::servo_ticks(1);
    expect(c.ms, c.line);
    platform::servo_ticks(200);
    expect(c.ms == 0 ? 0 : c.ms - 200 * kTickMs, c.line);
    ASSERT_EQ(host("A"), "");
    ticks(500);
  }
  store({"LINEAR TA100 TS0 TM200 X1", "X2"});
  ASSERT_EQ(host("&1 I5113=10 B1R"), "");
  for (int i = 0; i < 12; ++i) {
    platform::servo_ticks(50);
    ASSERT_TRUE(cs().active && cs().moves[cs().executing].kind == MOVE_SEGMENTS);
    expect(0, "segments");
  }
}

// Global word 1, bit 14.
TEST_F(StatusOfMoves, TablesAreOn) {
  EXPECT_EQ(host("???"), "000000000800");
  ASSERT_EQ(host("I51=1"), "");
  EXPECT_EQ(host("???"), "004000000800");
  ASSERT_EQ(host("I51=0"), "");
  EXPECT_EQ(host("???"), "000000000800");
}

}  // namespace
