// Fixed motion programs on the real image: they run, wait, call each other, and never take the controller from the
// host.
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

class MotionPrograms : public Controller {
 protected:
  void store(int number, const std::vector<std::string>& lines) {
    ASSERT_EQ(ask("OPEN PROG " + std::to_string(number) + " CLEAR"), "");
    for (const std::string& line : lines) ASSERT_EQ(ask(line), "") << line;
    ASSERT_EQ(ask("CLOSE"), "");
  }
  std::string status() { return ask("??"); }
  bool running() { return std::stoul(status().substr(0, 6), nullptr, 16) & 1; }
  bool error() { return (std::stoul(status().substr(6, 6), nullptr, 16) >> 22) & 1; }
  bool ended() { return !running() && ((std::stoul(status().substr(6, 6), nullptr, 16) >> 17) & 1) != 0; }
  bool finish(int ms) {
    for (; ms > 0 && !ended(); --ms) wait(ms_to_ticks(1));
    return ended();
  }
};

TEST_P(MotionPrograms, LoopsCallsAndMoves) {
  start();
  store(1000, {"N4000 READ(P) DWELL(Q116) RET"});
  store(5, {"TM10TA2TS0INC", "P1=0", "WHILE(P1<3)", "P1=P1+1", "IF(P1=2)", "G4P5", "ELSE", "GOSUB 100", "ENDIF", "X2",
            "ENDWHILE", "RETURN", "N100 P2=P2+P1", "RET"});
  ASSERT_EQ(ask("B5"), "");
  EXPECT_EQ(ask("LIST PC"), "0:TM10TA2TS0INC");
  ASSERT_EQ(ask("R"), "");
  EXPECT_TRUE(running());
  ASSERT_TRUE(finish(200));
  EXPECT_FALSE(error());
  EXPECT_EQ(ask("P1"), "3");
  EXPECT_EQ(ask("P2"), "4");
  EXPECT_EQ(ask("Q116"), "5");
  EXPECT_EQ(ask("PC"), "P5:0");
  EXPECT_EQ(ask("RL$2047"), "6") << "target of X";
}

TEST_P(MotionPrograms, EndlessLoopLeavesTheHostAndTheOtherSystems) {
  start();
  store(1, {"WHILE(1=1)", "P1=P1+1", "ENDWHILE"});
  store(2, {"TM5TA0TS0INC", "N1 X1 P2=P2+1 GOTO 1"});
  ASSERT_EQ(ask("&1B1R"), "");
  ASSERT_EQ(ask("&2B2R"), "");
  wait(ms_to_ticks(100));
  const Tick before = machine().now();
  EXPECT_GT(std::stoi(ask("P1")), 60) << "once at each real-time interrupt at least";
  EXPECT_LT(machine().now() - before, ms_to_ticks(3)) << "time of a reply";
  EXPECT_GT(std::stoi(ask("P2")), 15) << "moves of 5 ms follow each other";
  EXPECT_EQ(std::stoul(ask("???").substr(0, 6), nullptr, 16) & 0x508200u, 0u) << "no overrun, no watchdog";
  EXPECT_EQ(ask("OPEN PROG 3"), "ERR001");
  ASSERT_EQ(ask("&1A&2A"), "");
  wait(ms_to_ticks(3));
  EXPECT_FALSE(running());
}

TEST_P(MotionPrograms, RunTimeErrorAndWhatRunRefuses) {
  start();
  store(1, {"P1=1", "GOTO 7"});
  EXPECT_EQ(ask("R"), "ERR015");
  ASSERT_EQ(ask("B1R"), "");
  wait(ms_to_ticks(5));
  EXPECT_FALSE(running());
  EXPECT_TRUE(error());
  EXPECT_EQ(ask("LIST PC"), "1:GOTO7");
  EXPECT_EQ(ask("B2R"), "ERR015");
}

BRICK_ON_ENGINES(MotionPrograms, Engine::kSystemC, at_night(Engine::kLockstep));

}  // namespace
}  // namespace brick
