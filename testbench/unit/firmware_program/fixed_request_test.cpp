// BREQ and Fixed Buffer Full while a fixed buffer is open (I18, firmware:4.6, host-bus:5.7).
#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_program/platform.h"

namespace {

using platform::breq;
using platform::edges;
using platform::host;

class FixedRequest : public FirmwareTest {
 protected:
  static bool full() { return (std::stoul(host("???").substr(6), nullptr, 16) >> 11) & 1u; }
};

class FixedRequestOf : public FixedRequest, public ::testing::WithParamInterface<const char*> {};

INSTANTIATE_TEST_SUITE_P(All, FixedRequestOf, ::testing::Values("PROG 1", "PLC 1", "FORWARD"),
                         [](const auto& kind) { return std::string(kind.param, 3); });

// 26,624 words; a line of one word each. More than I18 open: high again.
TEST_P(FixedRequestOf, EachLinePulsesUntilNoMoreThanI18WordsAreOpen) {
  BRICK_COVERS("I18-2");
  ASSERT_EQ(host("I18=26620"), "");
  EXPECT_FALSE(breq());
  EXPECT_TRUE(full()) << "none is open";
  ASSERT_EQ(host(std::string("OPEN ") + GetParam()), "");
  EXPECT_TRUE(breq());
  EXPECT_FALSE(full());
  for (unsigned open = 26623; open >= 26618; --open) {
    platform::clear_edges();
    ASSERT_EQ(host("P1=1"), "");
    platform::pass_us(20);
    const bool ready = open > 26620;
    EXPECT_EQ(breq(), ready) << open;
    EXPECT_EQ(full(), !ready) << open;
    if (open < 26620) {
      EXPECT_EQ(edges().size(), 0u) << "it stays low";
      continue;
    }
    ASSERT_EQ(edges().size(), ready ? 2u : 1u) << open;
    EXPECT_FALSE(edges()[0].high);
    if (ready) { EXPECT_GE(edges()[1].us - edges()[0].us, 1.0); }
  }
  platform::clear_edges();
  ASSERT_EQ(host("CLEAR"), "");
  EXPECT_TRUE(breq());
  EXPECT_FALSE(full());
  ASSERT_EQ(host("CLOSE"), "");
  EXPECT_FALSE(breq());
  EXPECT_TRUE(full());
}

TEST_F(FixedRequest, ALineThatIsRefusedChangesNothing) {
  ASSERT_EQ(host("OPEN PROG 1"), "");
  platform::clear_edges();
  EXPECT_EQ(host("ENDIF"), "ERR009");
  EXPECT_EQ(host("X"), "ERR003");
  EXPECT_EQ(host("I17"), "10");
  EXPECT_TRUE(edges().empty());
  EXPECT_TRUE(breq());
}

TEST_F(FixedRequest, PulsesAreApart) {
  ASSERT_EQ(host("OPEN PLC 1"), "");
  platform::pass_us(20);
  platform::clear_edges();
  for (int i = 0; i < 5; ++i) ASSERT_EQ(host("P1=1"), "");  // no time passes between them
  ASSERT_EQ(edges().size(), 10u);
  for (std::size_t i = 1; i < edges().size(); ++i) EXPECT_GE(edges()[i].us - edges()[i - 1].us, 1.0) << i;
}

TEST_F(FixedRequest, AChangeOfI18IsFollowed) {
  BRICK_COVERS("I18-2");
  ASSERT_EQ(host("OPEN PROG 1 X1"), "");
  EXPECT_TRUE(breq());
  platform::set_i(18, 26623);  // as a program's assignment: nobody is told
  platform::real_time();
  EXPECT_FALSE(breq());
  EXPECT_TRUE(full());
  platform::set_i(18, 26622);
  platform::real_time();
  EXPECT_TRUE(breq());
  EXPECT_FALSE(full());
}

// Open memory also changes by other buffers, and the pin follows at once.
TEST_F(FixedRequest, BuffersThatComeAndGoMeanwhileAreFollowed) {
  BRICK_COVERS("I18-2");
  // 26,624 words less 10 a move of CCBUF, less 6 a segment and 2 an output of LOOKAHEAD: 4 and 6 are open, I18 = 10.
  for (const auto& [define, remove] :
       {std::pair{"DEF GAT", "DEL GAT"}, {"DEF CCBUF 2662", "DEL CCBUF"}, {"DEF LOOK 4436,1", "DEL LOOK"}}) {
    ASSERT_EQ(host("OPEN PROG 1"), "");
    ASSERT_TRUE(breq());
    ASSERT_EQ(host(define), "") << define;
    EXPECT_FALSE(breq()) << define;
    EXPECT_TRUE(full()) << define;
    ASSERT_EQ(host(remove), "") << remove;
    EXPECT_TRUE(breq()) << remove;
    EXPECT_FALSE(full()) << remove;
    ASSERT_EQ(host("CLOSE"), "");
  }
}

TEST_F(FixedRequest, WithoutRoomItNeverRises) {
  ASSERT_EQ(host("DEF GAT " + std::to_string(26624 - 10)), "");  // I18 = 10
  ASSERT_EQ(host("OPEN PROG 1"), "");
  EXPECT_FALSE(breq());
  EXPECT_TRUE(full());
  EXPECT_EQ(host("X1"), "");
  EXPECT_FALSE(breq());
  EXPECT_EQ(host("X1Y2Z3A4B5C6U7V8W9X10"), "ERR006") << "one word more than are open";
  EXPECT_FALSE(breq());
  EXPECT_TRUE(full());
}

// Written by who tells nobody, whatever the variables beside it are.
TEST_F(FixedRequest, AChangedI18IsNoticedByTheRealTimeTask) {
  for (const unsigned before : {10u, 7007u}) {  // I19 = 7007
    platform::set_i(18, before);
    ASSERT_EQ(host("OPEN PROG 1"), "");
    platform::real_time();
    ASSERT_TRUE(breq());
    platform::set_i(18, 26624);
    platform::real_time();
    EXPECT_FALSE(breq()) << before;
    EXPECT_TRUE(full()) << before;
    ASSERT_EQ(host("CLOSE"), "");
  }
}

// host-bus:5.7: an open fixed buffer owns the pin, then it shows the rotary one again.
TEST_F(FixedRequest, TheFixedBufferOwnsThePin) {
  BRICK_COVERS("I18-2 BREQ-7");
  ASSERT_EQ(host("&2DEF ROT 50 &1DEF ROT 100 B0 I16=2 I17=3 OPEN ROT"), "");
  for (int i = 0; i < 3; ++i) ASSERT_EQ(host("DWELL2"), "");
  ASSERT_EQ(host("CLOSE"), "");
  EXPECT_FALSE(breq()) << "full";
  ASSERT_EQ(host("R OPEN PLC 1"), "");
  EXPECT_FALSE(full());
  EXPECT_TRUE(breq());
  platform::clear_edges();
  ASSERT_EQ(host("&2"), "");
  ASSERT_EQ(host("&1"), "");
  platform::servo_ticks(100);
  EXPECT_EQ(host("PR"), "0") << "calculated meanwhile";
  EXPECT_TRUE(edges().empty());
  ASSERT_EQ(host("CLOSE"), "");
  EXPECT_TRUE(breq());
  ASSERT_EQ(host("A"), "");
}

}  // namespace
