// The control panel port of a Turbo PMAC: whose BREQ the host sees, groups of I59, run control by panel (host-bus:5.3,
// host-bus:5.6; servo-ic:11.8). Inputs are given as 1 = pulled low.
#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_program/platform.h"

namespace {

using platform::breq;
using platform::host;
using platform::panel;

constexpr std::uint32_t kPrejog = 1u << 2, kStart = 1u << 3, kStep = 1u << 4, kStop = 1u << 5, kHome = 1u << 6,
                        kHold = 1u << 7;
constexpr std::uint32_t fpd(std::uint32_t n) { return n << 8; }

class Panel : public FirmwareTest {
 protected:
  // Rotary buffers of C.S. 2 (room left) and C.S. 1 (full), opened; C.S. 1 stays addressed.
  static void open_two() {
    ASSERT_EQ(host("I16=1 I17=2"), "");
    ASSERT_EQ(host("&2DEF ROT 50"), "");
    ASSERT_EQ(host("&1DEF ROT 50"), "");
    ASSERT_EQ(host("&2OPEN ROT"), "");
    ASSERT_EQ(host("P1=1"), "");
    ASSERT_EQ(host("CLOSE &1OPEN ROT"), "");
    ASSERT_EQ(host("P1=1"), "");
    ASSERT_EQ(host("P1=1"), "");
    ASSERT_EQ(host("CLOSE"), "");
  }
};

TEST_F(Panel, BreqShowsTheCoordinateSystemOfThePanelWhenI2Is0) {
  BRICK_COVERS("BREQ-6");
  platform::fit_panel();
  open_two();
  ASSERT_EQ(host("&2"), "");
  EXPECT_FALSE(breq()) << "nothing is selected";
  panel(fpd(2));
  EXPECT_TRUE(breq());
  ASSERT_EQ(host("&1"), "");
  EXPECT_TRUE(breq()) << "the host's address does not matter";
  panel(fpd(1));
  EXPECT_FALSE(breq()) << "Full";
  panel(fpd(2));
  EXPECT_TRUE(breq());
  for (const unsigned n : {0u, 3u, 8u, 9u, 10u, 15u}) {
    panel(fpd(n));
    EXPECT_FALSE(breq()) << n;
  }
}

TEST_F(Panel, BreqShowsTheAddressedCoordinateSystemWhenI2Is1) {
  BRICK_COVERS("BREQ-6");
  platform::fit_panel();
  open_two();
  panel(fpd(2));
  ASSERT_TRUE(breq());
  ASSERT_EQ(host("I2=1"), "");
  EXPECT_FALSE(breq()) << "C.S. 1 is addressed and full";
  ASSERT_EQ(host("&2"), "");
  EXPECT_TRUE(breq());
  panel(fpd(1));
  EXPECT_TRUE(breq());
  ASSERT_EQ(host("I2=0"), "");
  EXPECT_FALSE(breq());
  ASSERT_EQ(host("I2=3"), "");
  EXPECT_TRUE(breq()) << "bit 0 alone says it";
  ASSERT_EQ(host("I2=2"), "");
  EXPECT_FALSE(breq());
}

TEST_F(Panel, BoardsWithoutAPanelAlwaysShowTheAddressedCoordinateSystem) {
  BRICK_COVERS("BREQ-7");
  open_two();
  ASSERT_EQ(host("I2=0"), "");
  panel(fpd(2) | kStart);
  EXPECT_FALSE(breq());
  EXPECT_FALSE(run_is_running(1));
  ASSERT_EQ(host("&2"), "");
  EXPECT_TRUE(breq());
}

// However long the background is kept from a pass: what it does for the host has no part in T_FPD.
TEST_F(Panel, TheRealTimeTaskAloneTakesTheSelection) {
  BRICK_COVERS("BREQ-6");
  platform::fit_panel();
  open_two();
  platform::pull_panel(fpd(2));
  platform::real_time();
  EXPECT_TRUE(breq());
  platform::pull_panel(fpd(1));
  platform::real_time();
  EXPECT_FALSE(breq());
}

// It does so before it calculates lines, which may take long: what a line selects shows with the next task.
TEST_F(Panel, SelectionComesBeforeTheCalculationOfLines) {
  BRICK_COVERS("BREQ-6");
  platform::fit_panel();
  ASSERT_EQ(host("&1DEF ROT 50 B0 OPEN ROT"), "");
  for (const char* line : {"I59=1 DWELL1000", "DWELL1"}) ASSERT_EQ(host(line), "");
  platform::pull_panel(fpd(1));
  ASSERT_EQ(host("CLOSE R"), "");
  platform::real_time();
  EXPECT_EQ(i_integer(59), 1) << "the line was calculated";
  EXPECT_TRUE(breq()) << "after the selection had been looked at";
  platform::real_time();
  EXPECT_FALSE(breq());
}

// Lines that enter another system's buffer do not move the pin; those of the selected one pulse it.
TEST_F(Panel, OnlyLinesOfTheSelectedSystemPulseBreq) {
  BRICK_COVERS("BREQ-6 BREQ-1");
  platform::fit_panel();
  open_two();
  ASSERT_EQ(host("&2 I17=10"), "");
  ASSERT_EQ(host("OPEN ROT"), "");
  panel(fpd(1));
  platform::pass_us(20);
  platform::clear_edges();
  ASSERT_EQ(host("P1=1"), "");
  EXPECT_TRUE(platform::edges().empty());
  panel(fpd(2));
  platform::pass_us(20);
  platform::clear_edges();
  ASSERT_EQ(host("P1=1"), "");
  ASSERT_EQ(platform::edges().size(), 2u);
  EXPECT_FALSE(platform::edges()[0].high);
  EXPECT_TRUE(platform::edges()[1].high);
}

TEST_F(Panel, I59ChoosesTheGroupOfEight) {
  BRICK_COVERS("BREQ-6");
  platform::fit_panel();
  for (unsigned group = 0; group < 4; ++group) {
    platform::set_i(59, group);
    for (unsigned n = 1; n <= 8; ++n) {
      panel(fpd(n));
      EXPECT_EQ(panel_cs() + 1, n + (group % 2 == 1 ? 8 : 0)) << "I59=" << group;
    }
  }
}

TEST_F(Panel, WithNothingSelectedFourInputsSetI59) {
  platform::fit_panel();
  const struct {
    std::uint32_t input;
    int group;
  } cases[] = {{kPrejog, 1}, {kStart, 2}, {kStep, 3}, {kHome, 0}};
  for (const auto& k : cases) {
    panel(k.input);
    EXPECT_EQ(i_integer(59), k.group);
    panel(0);
    EXPECT_EQ(i_integer(59), k.group) << "going high does nothing";
  }
  panel(kHold | kStop);
  EXPECT_EQ(i_integer(59), 0);
  for (const std::uint32_t n : {9u, 15u}) {
    panel(fpd(n));
    panel(fpd(n) | kPrejog);
    EXPECT_EQ(i_integer(59), 0) << n << " selects nothing and is not 0 either";
  }
  panel(0);
  ASSERT_EQ(host("I2=1"), "");
  panel(kStart);
  EXPECT_EQ(i_integer(59), 0) << "the inputs are free for other use";
}

TEST_F(Panel, StartStepHoldAndStopActOnTheSelectedSystem) {
  platform::fit_panel();
  ASSERT_EQ(host("&2DEF ROT 200 B0 OPEN ROT"), "");
  for (const char* line : {"TM100 TA40 TS0", "X1", "X2", "X3"}) ASSERT_EQ(host(line), "");
  ASSERT_EQ(host("CLOSE &1"), "");
  const coordinate_system& s = coordinate_systems[1];
  panel(kStart);
  panel(0);
  EXPECT_FALSE(run_is_running(1)) << "nothing is selected";
  platform::set_i(59, 0);
  panel(fpd(1) | kStart);
  EXPECT_FALSE(run_is_running(1));
  panel(fpd(2));
  panel(fpd(2) | kStart);
  EXPECT_TRUE(run_is_running(1));
  platform::servo_ticks(20);
  panel(fpd(2) | kHold);
  EXPECT_TRUE(s.held);
  panel(fpd(2));
  EXPECT_TRUE(s.held) << "released by START";
  panel(fpd(2) | kStart);
  EXPECT_FALSE(s.held);
  panel(fpd(2) | kStart | kStop);
  EXPECT_FALSE(run_is_running(1));
  platform::servo_ticks(3);
  panel(fpd(2));
  panel(fpd(2) | kStart | kStop);
  EXPECT_FALSE(run_is_running(1)) << "both at once: STOP wins";
  panel(fpd(2));
  panel(fpd(2) | kStep);
  EXPECT_TRUE(s.stepping);
}

TEST_F(Panel, StepOfARunningProgramQuitsIt) {
  platform::fit_panel();
  ASSERT_EQ(host("DEF ROT 200 B0 OPEN ROT"), "");
  for (const char* line : {"TM100 TA40 TS0", "X1", "X2", "X3", "X4"}) ASSERT_EQ(host(line), "");
  panel(fpd(1) | kStart);
  platform::servo_ticks(20);
  ASSERT_TRUE(run_is_running(0));
  panel(fpd(1) | kStep);
  platform::servo_ticks(2000);
  EXPECT_FALSE(run_is_running(0));
  EXPECT_LT(coordinate_systems[0].position[AXIS_X], 4.0) << "the calculated moves were finished, the rest kept";
}

// Before the first real-time task: what the panel shows at start-up holds from there on.
TEST_F(Panel, SelectionIsThereFromTheStart) {
  BRICK_COVERS("BREQ-6");
  platform::fit_panel();
  panel(0);
  platform::pull_panel(fpd(3));
  EXPECT_EQ(panel_cs(), COORDINATE_SYSTEMS);
  panel_initialize();
  EXPECT_EQ(panel_cs(), 2u);
}

// The ring of before the start is gone, whoever selects its system: there is nothing to be filled.
TEST_F(Panel, BufferOfBeforeTheStartAsksForNothing) {
  BRICK_COVERS("BREQ-6");
  platform::fit_panel();
  for (const char* line : {"I2=0", "SAVE"}) ASSERT_EQ(platform::host(line), "") << line;
  panel(fpd(1));
  for (const char* line : {"&1DEF ROT 100", "&1B0", "OPEN ROT"}) ASSERT_EQ(platform::host(line), "") << line;
  ASSERT_TRUE(platform::breq());
  platform::reset("$$$");
  ASSERT_EQ(panel_cs(), 0u);
  EXPECT_FALSE(platform::breq());
}

TEST_F(Panel, InputsThatAreLowAtStartAskForNothing) {
  platform::fit_panel();
  panel(kStart);
  platform::set_i(59, 1);
  panel_initialize();
  panel_pass();
  EXPECT_EQ(i_integer(59), 1);
}

}  // namespace
