// Fixed buffers on the real image: BREQ by pin, interrupt controller and `???` while PROG and PLC are entered (I18).
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

class FixedBuffers : public Controller {
 protected:
  bool full() { return (std::stoul(ask("???").substr(6), nullptr, 16) >> 11) & 1; }
  bool breq() { return machine().outputs().get(pin::kBreq) != 0; }
  void settle() { wait(ms_to_ticks(1)); }
};

TEST_P(FixedBuffers, BreqFollowsTheOpenWords) {
  BRICK_COVERS("I18-2 CARD-3");
  start();
  ASSERT_EQ(ask("I18=26620"), "");
  for (const char* open : {"OPEN PROG 1 CLEAR", "OPEN PLC 1 CLEAR"}) {
    EXPECT_TRUE(full()) << "none is open";
    ASSERT_EQ(ask(open), "");
    settle();
    EXPECT_TRUE(breq()) << open;
    EXPECT_FALSE(full()) << open;
    for (int words = 26623; words >= 26619; --words) {
      ASSERT_EQ(ask("P1=1"), "");
      settle();
      EXPECT_EQ(breq(), words > 26620) << open << ", " << words << " words open";
      EXPECT_EQ(full(), words <= 26620) << open << ", " << words << " words open";
      EXPECT_EQ((bus().read_pic().sig >> 1) & 1, breq() ? 1 : 0);
    }
    ASSERT_EQ(ask("CLEAR"), "");
    settle();
    EXPECT_TRUE(breq()) << "room again";
    ASSERT_EQ(ask("CLOSE"), "");
    settle();
    EXPECT_FALSE(breq()) << "no rotary buffer is there";
  }
}

TEST_P(FixedBuffers, TheOpenFixedBufferOwnsThePin) {
  BRICK_COVERS("I18-2");
  start();
  ASSERT_EQ(ask("&1DEFINE ROTARY 50"), "");
  ASSERT_EQ(ask("I17=1"), "");
  ASSERT_EQ(ask("OPEN ROTARY"), "");
  ASSERT_EQ(ask("X1"), "");
  ASSERT_EQ(ask("CLOSE"), "");
  settle();
  ASSERT_FALSE(breq()) << "the ring is full";
  ASSERT_EQ(ask("OPEN PLC 2"), "");
  settle();
  EXPECT_TRUE(breq());
  ASSERT_EQ(ask("&2"), "");
  settle();
  EXPECT_TRUE(breq()) << "whatever is addressed";
  ASSERT_EQ(ask("&1 CLOSE"), "");
  settle();
  EXPECT_FALSE(breq());
}

TEST_P(FixedBuffers, ProgramsComeBackAfterSaveAndReset) {
  start();
  ASSERT_EQ(ask("OPEN PROG 5 CLEAR X1 Y(P1*2) CLOSE"), "");
  ASSERT_EQ(ask("OPEN PLC 3 IF(P1=$10) CMD\"#1j+\" ENDIF CLOSE"), "");
  ASSERT_EQ(ask("SAVE"), "");
  ASSERT_EQ(ask("OPEN PROG 5 CLEAR CLOSE"), "");
  ASSERT_EQ(ask("$$$"), "");
  EXPECT_EQ(ask("LIST PROG 5"), "X1Y(P1*2)|RET");
  EXPECT_EQ(ask("LIST PLC 3,1,3"), "3:CMD\"#1j+\"");
}

BRICK_ON_ENGINES(FixedBuffers, at_night(Engine::kRtl), Engine::kSystemC, Engine::kLockstep);

}  // namespace
}  // namespace brick
