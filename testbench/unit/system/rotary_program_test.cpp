// Rotary programs on the real image: entry, BREQ pin, Full bit, execution and its timing.
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

class RotaryProgram : public Controller {
 protected:
  static unsigned long status_word2(const std::string& reply) { return std::stoul(reply.substr(6, 6), nullptr, 16); }
  bool full(int cs) { return (status_word2(ask("&" + std::to_string(cs) + "??")) >> 16) & 1; }
  bool running(int cs) { return std::stoul(ask("&" + std::to_string(cs) + "??").substr(0, 6), nullptr, 16) & 1; }
  bool breq() { return machine().outputs().get(pin::kBreq) != 0; }
  void open(int cs, int words = 400) {
    ASSERT_EQ(ask("&" + std::to_string(cs) + "DEFINE ROTARY " + std::to_string(words)), "");
    ASSERT_EQ(ask("B0"), "");
    ASSERT_EQ(ask("OPEN ROTARY"), "");
  }
};

TEST_P(RotaryProgram, FullAndBreqFollowI17OnEntry) {
  BRICK_COVERS("BREQ-1 BREQ-2 BREQ-3 BREQ-5");
  start();
  open(1);
  for (int line = 1; line <= 12; ++line) {
    ASSERT_EQ(ask("X" + std::to_string(line)), "");
    wait(ms_to_ticks(1));
    EXPECT_EQ(ask("PR"), std::to_string(line));
    EXPECT_EQ(breq(), line < 10) << "line " << line;
    EXPECT_EQ(full(1), line >= 10) << "line " << line;
    EXPECT_EQ((bus().read_pic().sig >> 1) & 1, breq() ? 1 : 0);
  }
}

TEST_P(RotaryProgram, BreqComesBackBelowI16OnExecution) {
  BRICK_COVERS("BREQ-4");
  start();
  open(1);
  ask("TM5 TA0 TS0");
  for (int line = 0; line < 10; ++line) ask("DWELL5");
  ASSERT_TRUE(full(1));
  ASSERT_EQ(ask("R"), "");
  const BoardOutputs stop = select_pins(pin::kBreq);
  const Tick end = machine().now() + ms_to_ticks(100);
  machine().run_until(end, stop);
  ASSERT_TRUE(breq()) << "BREQ must rise when fewer than I16 lines are ahead";
  EXPECT_EQ(ask("PR"), "4") << "I16 = 5: rises on dropping below 5";
  EXPECT_FALSE(full(1));
}

TEST_P(RotaryProgram, DwellTakesItsTime) {
  start();
  open(1);
  for (const char* line : {"P1=1", "DWELL20", "P1=2", "DWELL30", "P1=3"}) ASSERT_EQ(ask(line), "");
  ASSERT_EQ(ask("R"), "");
  const Tick begin = machine().now();
  while (ask("P1") != "3" && machine().now() < begin + ms_to_ticks(200)) wait(ms_to_ticks(1));
  const Tick elapsed = machine().now() - begin;
  EXPECT_GE(elapsed, ms_to_ticks(45));
  EXPECT_LE(elapsed, ms_to_ticks(56));
}

TEST_P(RotaryProgram, WaitsForMoreLinesWithoutError) {
  start();
  open(1);
  ASSERT_EQ(ask("R"), "") << "R on an empty rotary buffer is accepted";
  EXPECT_TRUE(running(1));
  ASSERT_EQ(ask("P5=17"), "") << "stored as a program line";
  wait(ms_to_ticks(5));
  EXPECT_EQ(ask("PR"), "0");
  EXPECT_EQ(ask("P5"), "17");
  EXPECT_TRUE(running(1));
  EXPECT_EQ(ask("Q"), "");
  wait(ms_to_ticks(5));
  EXPECT_FALSE(running(1));
}

TEST_P(RotaryProgram, PinShowsTheAddressedCoordinateSystem) {
  BRICK_COVERS("BREQ-7");
  start();
  ASSERT_EQ(ask("&2DEFINE ROTARY 100"), "");
  ASSERT_EQ(ask("&1DEFINE ROTARY 100"), "");
  ASSERT_EQ(ask("I17=2 I16=1"), "");
  ASSERT_EQ(ask("OPEN ROTARY"), "");
  ask("&2");
  ask("X1");
  ask("X2");
  ask("X3");
  wait(ms_to_ticks(1));
  EXPECT_FALSE(breq()) << "C.S. 2 is full";
  ask("&1");
  wait(ms_to_ticks(1));
  EXPECT_TRUE(breq()) << "C.S. 1 is empty";
  ask("&2");
  wait(ms_to_ticks(1));
  EXPECT_FALSE(breq());
}

TEST_P(RotaryProgram, ReplyOfPrNeedsARotaryBuffer) {
  start();
  EXPECT_EQ(ask("&3PR").substr(0, 3), "ERR");
}

BRICK_ON_ENGINES(RotaryProgram, at_night(Engine::kRtl), Engine::kSystemC, Engine::kLockstep);

}  // namespace
}  // namespace brick
