// The number that says why a program was stopped (firmware:7.10), by its cause; it goes with bit 22 of word 2.
#include "testbench/unit/firmware_platform/fake_tasks.h"
#include "testbench/unit/firmware_program/motion_program.h"

namespace {

using motion_program::MotionProgram;
using platform::host;
using Lines = std::vector<std::string>;

class RunTimeErrors : public MotionProgram {
 protected:
  static std::string number(unsigned cs = 1) { return host("RY$" + std::string(cs == 1 ? "2014" : "2114")); }
};

std::string repeated(const std::string& text, unsigned times) {
  std::string all;
  while (times-- != 0) all += text;
  return all;
}

TEST_F(RunTimeErrors, EachCauseHasItsNumber) {
  store(7, {"P7=1"});
  store(8, {"CALL8"});
  ASSERT_EQ(host("OPEN PROG 9 CLEAR"), "");
  ASSERT_EQ(host("IF(P1=0)"), "");
  ASSERT_EQ(host("CLOSE"), "ERR009") << "closed all the same";
  const struct {
    const char* number;
    Lines lines;
  } causes[] = {
      {"1", {"CC1 X1Y1"}},    {"1", {"X1R5"}},     {"2", {"CALL99"}},
      {"2", {"CALL99.5"}},    {"2", {"G1"}},       {"2", {"CALL(-1)"}},
      {"2", {"CALL(40000)"}}, {"3", {"GOTO5"}},    {"3", {"GOSUB5"}},
      {"3", {"CALL7.5"}},     {"3", {"GOTO(-1)"}}, {"3", {"GOSUB(300000)"}},
      {"4", {"CALL8"}},       {"5", {"CALL9"}},    {"6", {repeated("M1==1", 33), "X1"}},
      {"7", {"READ(X)"}},
  };
  ASSERT_EQ(host("M1->*"), "");
  for (const auto& cause : causes) {
    SCOPED_TRACE(cause.lines[0]);
    store(1, {"P5=7"});
    ASSERT_EQ(host("B1R"), "");
    ASSERT_TRUE(finish());
    EXPECT_EQ(number(), "0") << "no error of this run, whatever the one before had";
    run(cause.lines);
    EXPECT_TRUE(error());
    EXPECT_EQ(number(), cause.number);
    EXPECT_EQ(number(2), "0") << "the other system has none";
    ASSERT_EQ(host("WY$2014,99"), "");
    EXPECT_EQ(number(), cause.number) << "a host cannot write it";
  }
}

TEST_F(RunTimeErrors, ItIsThatOfTheSystemAndGoesWithTheNextStart) {
  store(1, {"CALL99"});
  ASSERT_EQ(host("&2B1R"), "");
  platform::servo_ticks(9);
  EXPECT_EQ(number(2), "2");
  EXPECT_EQ(number(1), "0");
  EXPECT_EQ(host("&2Q RY$2114"), "2") << "it stays until the program is started again";
  ASSERT_EQ(host("OPEN PROG 2 CLEAR DWELL100 CLOSE &2B2"), "");
  EXPECT_EQ(number(2), "2");
  ASSERT_EQ(host("R"), "");
  EXPECT_EQ(number(2), "0");
}

// What is left of the line in error is skipped in slices, and an abort comes between two of them: it forgets the cause,
// the next error has its own.
TEST_F(RunTimeErrors, AnAbortWithinOneLeavesNothingToTheNext) {
  unsigned within = 0;
  for (unsigned slices = 1; slices <= 12; ++slices) {
    platform::power_up();
    ASSERT_EQ(host("DEF ROT 100 B0 OPEN ROT"), "");
    ASSERT_EQ(host("CALL99 P1=1 P2=2 P3=3 P4=4"), "");
    const std::uint32_t next = rotary_buffers[0].used;
    ASSERT_EQ(host("CC1 X1Y1R5"), "");
    const std::uint32_t words = rotary_buffers[0].used;
    ASSERT_EQ(host("CLOSE R"), "");
    fake_hal_on_pause([] {});
    fake_hal_slices_leave(true);
    for (unsigned i = 0; i < slices; ++i) fake_task_run_real_time();
    const std::uint32_t left = rotary_buffers[0].used;
    if (left > words - next && left < words - 1 && fake_hal_slice_is_left() && !error()) ++within;
    EXPECT_EQ(host("A"), "");
    fake_hal_slices_leave(false);
    fake_hal_on_pause(nullptr);
    for (unsigned i = 0; i < 2 && host("PR") != "0"; ++i) {
      platform::real_time();
      ASSERT_EQ(host("R"), "");
      platform::servo_ticks(9);
    }
    EXPECT_TRUE(error());
    EXPECT_EQ(number(), "1") << "behind " << slices << " slices";
  }
  EXPECT_GT(within, 1u) << "no abort fell among the words that are skipped";
}

// firmware:7.10: the line of a rotary buffer goes, though the error is in a program that it calls.
TEST_F(RunTimeErrors, OneInACalledProgramTakesTheLineThatCalls) {
  store(7, {"P1=1", "CALL8 P2=2"});
  store(8, {"P3=3", "CALL99 P4=4"});
  ASSERT_EQ(host("DEF ROT 100 B0 OPEN ROT"), "");
  ASSERT_EQ(host("CALL7 P5=5"), "");
  ASSERT_EQ(host("P6=6"), "");
  ASSERT_EQ(host("CLOSE R"), "");
  ASSERT_TRUE(finish());
  EXPECT_TRUE(error());
  EXPECT_EQ(number(), "2");
  EXPECT_EQ(host("P1..6"), "1|0|3|0|0|0");
  EXPECT_EQ(host("PR"), "1");
  EXPECT_EQ(host("PC").find('>'), std::string::npos) << "it is in no call any more";
  ASSERT_EQ(host("P1=0 P3=0 R"), "");
  platform::servo_ticks(9);
  EXPECT_FALSE(error());
  EXPECT_EQ(host("P1..6"), "0|0|0|0|0|6") << "no way back into the programs";
}

// What an abort has dropped is nothing that later assignments count: the first one comes with the next program's move.
TEST_F(RunTimeErrors, BehindAnAbortAssignmentsComeWithTheirMoves) {
  store(1, {"TM60TA10TS0 X1", "X2", "X3"});
  store(2, {"TM60TA10TS0 M1==5 X4", "M1==6 X5", "X6"});
  ASSERT_EQ(host("M1->X:$10F0,0,24 M1=0 B1R"), "");
  platform::servo_ticks(60);
  ASSERT_TRUE(coordinate_systems[0].next_valid);
  ASSERT_EQ(host("A"), "");
  platform::servo_ticks(9);
  const std::uint32_t started = coordinate_systems[0].started;
  ASSERT_EQ(host("B2R"), "");
  for (unsigned move = 1; move <= 2; ++move) {
    for (unsigned i = 0; i < 1000 && coordinate_systems[0].started - started < move; ++i) platform::servo_ticks(1);
    platform::servo_ticks(3);
    EXPECT_EQ(host("M1"), std::to_string(4 + move));
  }
}

}  // namespace
