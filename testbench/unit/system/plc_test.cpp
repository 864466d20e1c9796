// PLCs on the real image: nothing of a background PLC holds the host or the watchdog up, saved ones start by
// themselves.
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

class PlcProgram : public Controller {
 protected:
  void load(int number, const std::vector<std::string>& lines) {
    ASSERT_EQ(ask("OPEN PLC " + std::to_string(number) + " CLEAR"), "");
    for (const std::string& line : lines) ASSERT_EQ(ask(line), "") << line;
    ASSERT_EQ(ask("CLOSE"), "");
  }
};

TEST_P(PlcProgram, EndlessLoopInTheBackgroundStarvesNobody) {
  start();
  load(1, {"WHILE(1=1)", "P1=P1+1", "ENDWHILE"});
  load(2, {"P2=P2+1"});
  ASSERT_EQ(ask("I40=20 I5=2 ENABLE PLC 1,2"), "");  // 20 servo cycles are 8.9 ms
  wait(ms_to_ticks(60));
  EXPECT_EQ(ask("VERSION"), "1.947");
  EXPECT_EQ(machine().outputs().get(pin::kWdTripped), 0u);
  EXPECT_GT(std::stod(ask("P1")), 50.0);
  EXPECT_GT(std::stod(ask("P2")), 50.0);
  EXPECT_EQ(ask("???"), "000000000800");
}

// A scan of some 20 ms: 1500 sines in a row. Control characters do not wait for its end.
TEST_P(PlcProgram, ControlDActsInTheMiddleOfALongScan) {
  start();
  ASSERT_EQ(ask("OPEN PLC 1 CLEAR"), "");
  std::string sines = "P3=SIN(1)";
  for (int i = 0; i < 14; ++i) sines += "+SIN(1)";
  for (int i = 0; i < 20; ++i) ASSERT_EQ(ask(sines), "");
  ASSERT_EQ(ask("P1=P1+1"), "");
  ASSERT_EQ(ask("CLOSE"), "");
  load(0, {"P2=P2+1"});
  ASSERT_EQ(ask("I5=3 ENABLE PLC 0,1"), "");
  wait(ms_to_ticks(30));
  ASSERT_TRUE(bus().put_char(0x04, ms_to_ticks(1)));
  wait(ms_to_ticks(1));
  const std::string scans = ask("P2");
  EXPECT_GT(std::stod(scans), 10.0);
  wait(ms_to_ticks(30));
  EXPECT_EQ(ask("P2"), scans);
  EXPECT_GT(std::stod(ask("P1")), 0.0);
}

TEST_P(PlcProgram, SavedOnesStartWithTheController) {
  start();
  load(1, {"P1=P1+1", "DISABLE PLC 3"});
  load(3, {"P3=P3+1"});
  load(4, {"P4=P4+1"});
  ASSERT_EQ(ask("P1=0 P3=0 P4=0 I5=2 SAVE"), "");
  ASSERT_EQ(ask("$$$"), "");
  wait(ms_to_ticks(5));
  EXPECT_GT(std::stod(ask("P1")), 0.0);
  EXPECT_EQ(ask("P3"), "0") << "PLC 1 is the first and can disable the others";
  EXPECT_GT(std::stod(ask("P4")), 0.0);
}

// ^X comes right behind ^D, while the background looks whether there is room.
TEST_P(PlcProgram, TextsThatNobodyReadsHoldNobodyUp) {
  start();
  load(1, {"SEND\"a text of a program, sent over and over again\""});
  load(2, {"P2=P2+1"});
  ASSERT_EQ(ask("I5=2 ENABLE PLC 1,2"), "");
  wait(ms_to_ticks(60));
  ASSERT_TRUE(bus().put_char(0x04, ms_to_ticks(1)));  // ^D
  ASSERT_TRUE(bus().put_char(0x18, ms_to_ticks(1)));  // ^X
  wait(ms_to_ticks(5));
  link().poll();
  link().take_unsolicited();
  EXPECT_EQ(ask("VERSION"), "1.947");
  EXPECT_GT(std::stod(ask("P2")), 100.0);
}

// 8192 values, of which the port holds 4096 characters.
TEST_P(PlcProgram, LongReplyThatNobodyReadsHoldsNobodyUp) {
  start();
  load(1, {"CMDP\"P0..8191\"", "DISABLE PLC 1"});
  load(2, {"P2=P2+1"});
  ASSERT_EQ(ask("I5=2 ENABLE PLC 1,2"), "");
  wait(ms_to_ticks(60));
  ASSERT_TRUE(bus().put_char(0x18, ms_to_ticks(1)));  // ^X
  wait(ms_to_ticks(5));
  link().poll();
  link().take_unsolicited();
  EXPECT_GT(std::stod(ask("P2")), 100.0);
}

BRICK_ON_ENGINES(PlcProgram, Engine::kSystemC, at_night(Engine::kLockstep));

}  // namespace
}  // namespace brick
