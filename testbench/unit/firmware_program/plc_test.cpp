// PLCs (firmware:4.3, firmware:7.2, firmware:8.1): which run, in which order, how far a turn goes, where it goes on.
#include "testbench/unit/firmware_program/platform.h"

extern "C" {
#include "firmware/run/plc.h"
#include "testbench/unit/firmware_platform/fake_hal.h"
#include "testbench/unit/firmware_platform/fake_tasks.h"
}

namespace {

using platform::background;
using platform::host;
using platform::servo_ticks;
using Lines = std::vector<std::string>;

class Plc : public FirmwareTest {
 protected:
  static void load(int number, const Lines& lines) {
    ASSERT_EQ(host("OPEN PLC " + std::to_string(number) + " CLEAR"), "");
    for (const std::string& line : lines) ASSERT_EQ(host(line), "") << line;
    ASSERT_EQ(host("CLOSE"), "");
  }
  // Appends its number to the list P201, P202, ... whose length is P200.
  static Lines logs(int number) { return {"P200=P200+1", "P(200+P200)=" + std::to_string(number)}; }
  static std::string list() {
    std::string text;
    for (unsigned i = 1; i <= static_cast<unsigned>(p_variable_read(200)); ++i)
      text += static_cast<char>('0' + static_cast<int>(p_variable_read(200 + i)));
    return text;
  }
  static double p(unsigned number) { return p_variable_read(number); }
  // As a client defines it: M50nn -> Y:$31nn,22, 0 while it runs.
  static bool shown_running(unsigned number) { return (*hal_y(0x3100 + number) >> 22 & 1u) == 0; }
};

TEST_F(Plc, BackgroundPlcsTakeTurnsInRisingOrderOneScanAPass) {
  for (const int n : {7, 2, 5, 1}) load(n, logs(n));
  ASSERT_EQ(host("I5=2 ENABLE PLC 1..2,5,7"), "");
  background(1);
  EXPECT_EQ(list(), "1") << "PLC 1 is the first after a start";
  background(8);
  EXPECT_EQ(list(), "125712571");
}

TEST_F(Plc, MissingOnesAreDisabledWhenTheirTurnComes) {
  load(3, logs(3));
  ASSERT_EQ(host("I5=2 ENABLE PLC 1..4"), "");
  background(8);
  EXPECT_EQ(plc_enabled(), 1u << 3);
  EXPECT_EQ(list().substr(0, 3), "333");
  EXPECT_FALSE(shown_running(1));
  EXPECT_TRUE(shown_running(3));
}

TEST_F(Plc, I5SaysWhichClassRuns) {
  load(0, {"P1=P1+1"});
  load(4, {"P2=P2+1"});
  ASSERT_EQ(host("ENABLE PLC 0,4"), "");
  for (int i5 = 0; i5 <= 3; ++i5) {
    ASSERT_EQ(host("P1=0 P2=0 I5=" + std::to_string(i5)), "");
    background(5);
    EXPECT_EQ(p(1), 0.0) << "PLC 0 is not of the background";
    servo_ticks(9);  // I8 = 2: three real-time interrupts
    EXPECT_EQ(p(1), (i5 & 1) != 0 ? 3.0 : 0.0) << i5;
    EXPECT_EQ(p(2), (i5 & 2) != 0 ? 5.0 : 0.0) << i5;
  }
}

TEST_F(Plc, Plc0ScansOnceARealTimeInterruptByI8) {
  load(0, {"P1=P1+1"});
  ASSERT_EQ(host("I5=1 ENABLE PLC 0"), "");
  background(1);  // reads its blocks
  for (const int i8 : {0, 1, 4, 9}) {
    ASSERT_EQ(host("I8=" + std::to_string(i8)), "");
    servo_ticks(10);  // whatever the prescaler stood at
    const double before = p(1);
    servo_ticks(120);
    EXPECT_EQ(p(1) - before, 120.0 / (i8 + 1)) << i8;
  }
  const double before = p(1);
  platform::real_time();  // one that a control character has asked for
  EXPECT_EQ(p(1), before);
}

// However long it is: its blocks are looked for in the background, not in the interrupt.
TEST_F(Plc, Plc0BeginsWhenTheBackgroundHasReadItsBlocks) {
  load(0, {"IF(P2=0)", "P1=P1+1", "ENDIF"});
  ASSERT_EQ(host("I5=1"), "");
  plc_enable(1);
  servo_ticks(9);
  EXPECT_EQ(p(1), 0.0);
  EXPECT_TRUE(plc_background_any());
  background(1);
  EXPECT_FALSE(plc_background_any());
  servo_ticks(9);
  EXPECT_EQ(p(1), 3.0);
}

TEST_F(Plc, LoopOfABackgroundPlcGivesWayAndGoesOn) {
  load(1, {"P10=0", "WHILE(P10<3)", "P10=P10+1", "ENDWHILE", "P11=P11+1"});
  load(2, {"P12=P12+1"});
  ASSERT_EQ(host("I5=2 ENABLE PLC 1,2"), "");
  const Lines expected = {"1|0|0", "1|0|1", "2|0|1", "2|0|2", "3|0|2", "3|0|3", "3|1|3"};
  for (const std::string& values : expected) {  // three turns end at ENDWHILE, the fourth finds the loop over
    background(1);
    EXPECT_EQ(host("P10..12"), values);
  }
}

TEST_F(Plc, LoopOfPlc0IsExecutedInOneScan) {
  load(0, {"P10=0", "WHILE(P10<50)", "P10=P10+1", "ENDWHILE", "P11=P11+1"});
  ASSERT_EQ(host("I5=1 ENABLE PLC 0"), "");
  background(1);
  servo_ticks(3);
  EXPECT_EQ(host("P10 P11"), "50|1");
}

TEST_F(Plc, NestedBlocksAndConditionsGovernAScan) {
  load(1, {"IF(P1=1)", "AND(P2=1)", "P10=P10+1", "ELSE", "IF(P1=2)", "OR(P2=2)", "P11=P11+1", "ELSE", "P12=P12+1",
           "ENDIF", "ENDIF", "P13=P13+1"});
  ASSERT_EQ(host("I5=2 ENABLE PLC 1"), "");
  for (const char* set : {"P1=1 P2=1", "P1=1 P2=0", "P1=2 P2=0", "P1=0 P2=2", "P1=0 P2=0"}) {
    ASSERT_EQ(host(set), "");
    background(1);
  }
  EXPECT_EQ(host("P10..13"), "1|2|2|5");
}

TEST_F(Plc, DisabledPlcEndsItsScanAndBeginsAtTheTop) {
  load(1, {"P1=P1+1", "DISABLE PLC 1", "P2=P2+1"});
  ASSERT_EQ(host("I5=2 ENABLE PLC 1"), "");
  background(5);
  EXPECT_EQ(host("P1 P2"), "1|1") << "disabled, it ends its scan";
  EXPECT_FALSE(shown_running(1));
  ASSERT_EQ(host("ENAPLC1"), "");
  EXPECT_TRUE(shown_running(1));
  background(5);
  EXPECT_EQ(host("P1 P2"), "2|2");

  load(2, {"P3=P3+1", "WHILE(P4=0)", "ENDWHILE", "P5=P5+1"});
  ASSERT_EQ(host("ENABLE PLC 2"), "");
  background(5);
  EXPECT_EQ(host("P3 P5"), "1|0");
  ASSERT_EQ(host("ENABLE PLC 2"), "");
  background(2);
  EXPECT_EQ(host("P3 P5"), "1|0") << "it runs: nothing to enable";
  ASSERT_EQ(host("DISABLE PLC 2 ENABLE PLC 2"), "");
  background(2);
  EXPECT_EQ(host("P3 P5"), "2|0") << "out of its loop, at the top";
}

TEST_F(Plc, PausedPlcGoesOnWhereItWas) {
  load(1, {"P1=P1+1", "PAUSE PLC 1", "P2=P2+1"});
  ASSERT_EQ(host("I5=2 ENABLE PLC 1"), "");
  background(3);
  EXPECT_EQ(host("P1 P2"), "1|0") << "it stops behind its PAUSE";
  EXPECT_FALSE(shown_running(1));
  ASSERT_EQ(host("RESUME PLC 1"), "");
  background(1);
  EXPECT_EQ(host("P1 P2"), "1|1");
  background(1);
  EXPECT_EQ(host("P1 P2"), "2|1");
  ASSERT_EQ(host("ENABLE PLC 1"), "");  // paused: from the top
  background(1);
  EXPECT_EQ(host("P1 P2"), "3|1");
  ASSERT_EQ(host("DISPLC1 RESPLC1"), "");
  background(3);
  EXPECT_EQ(host("P1 P2"), "3|1") << "a disabled one is not resumed";
}

// Whatever stands behind its PAUSE, a statement of one word too, is for RESUME.
TEST_F(Plc, PausedPlcExecutesNothingBehindItsPause) {
  load(1, {"PAUSE PLC 1", "P2=2", "P3=3"});
  ASSERT_EQ(host("I5=2 ENABLE PLC 1"), "");
  background(3);
  EXPECT_EQ(host("P2 P3"), "0|0");
  ASSERT_EQ(host("RESUME PLC 1"), "");
  background(1);
  EXPECT_EQ(host("P2 P3"), "2|3");
}

// PLC 1 paused from above at the nth time that its first scan lets interrupts come; false: that is not within the scan.
bool paused_at(unsigned n) {
  static unsigned left;
  left = n;
  fake_hal_on_unmask([] {
    if (--left != 0) return;
    fake_hal_on_unmask(nullptr);
    plc_pause(1u << 1);
  });
  background(1);
  fake_hal_on_unmask(nullptr);
  background(2);
  return left == 0;
}

// PAUSE stops behind a statement (firmware:7.2), and an IF goes as far as its AND.
TEST_F(Plc, APauseWithinAStatementLetsItEnd) {
  unsigned within = 0;
  bool begun = false;
  for (unsigned n = 1; n < 60; ++n) {
    platform::power_up();
    load(1, {"P3=1+M1+M1+M1+M1+M1+M1+M1+M1", "P4=1", "P5=1"});
    ASSERT_EQ(host("M1->D:$10F0 I5=2 ENABLE PLC 1"), "");
    if (!paused_at(n)) break;
    EXPECT_TRUE(p(3) == 1.0 || !begun) << n;
    begun = p(3) == 1.0;
    if (begun && p(4) == 0.0) ++within;
    const double end = p(3) + p(4) + p(5);
    ASSERT_EQ(host("RESUME PLC 1"), "");
    background(1);
    EXPECT_EQ(host("P3..5"), "1|1|1") << n << " behind " << end;
  }
  EXPECT_GE(within, 8u) << "each look at M1 is a place";

  unsigned between = 0;
  for (unsigned n = 1; n < 60; ++n) {
    platform::power_up();
    load(1, {"P2=1", "IF(M1=0)", "AND(P5=0)", "P3=1", "ENDIF", "P4=1"});
    ASSERT_EQ(host("M1->D:$10F0 I5=2 ENABLE PLC 1"), "");
    if (!paused_at(n)) break;
    if (p(2) != 1.0 || p(3) != 0.0) continue;
    ASSERT_EQ(host("P5=1 RESUME PLC 1"), "");
    background(1);
    between += p(3) == 1.0 ? 1u : 0u;
  }
  EXPECT_GE(between, 1u) << "the AND was looked at before the pause";
}

TEST_F(Plc, PlcsControlEachOtherByListsAndRanges) {
  for (const int n : {1, 2, 3, 4}) load(n + 10, {"P" + std::to_string(n) + "=P" + std::to_string(n) + "+1"});
  load(1, {"IF(P10=1)", "DISABLE PLC 11..12,14", "P10=0", "ENDIF", "IF(P10=2)", "ENABLE PLC 11,12", "PAUSE PLC 13",
           "P10=0", "ENDIF", "IF(P10=3)", "RESUME PLC 13", "P10=0", "ENDIF"});
  ASSERT_EQ(host("I5=2 ENABLE PLC 1,11..14"), "");
  background(10);
  EXPECT_EQ(host("P1..4"), "2|2|2|2");
  ASSERT_EQ(host("P10=1"), "");
  background(4);
  EXPECT_EQ(plc_enabled(), 1u << 1 | 1u << 13);
  ASSERT_EQ(host("P10=2"), "");
  background(4);
  EXPECT_EQ(plc_enabled(), 1u << 1 | 1u << 11 | 1u << 12);
  ASSERT_EQ(host("P10=3"), "");
  background(4);
  EXPECT_EQ(plc_enabled(), 1u << 1 | 7u << 11);
}

TEST_F(Plc, Plc0DisablesABackgroundPlcAndItself) {
  load(0, {"DISABLE PLC 0,3", "P1=P1+1"});
  load(3, {"P2=P2+1"});
  ASSERT_EQ(host("I5=3 ENABLE PLC 0,3"), "");
  background(2);
  servo_ticks(9);
  background(2);
  EXPECT_EQ(host("P1 P2"), "1|2");
}

TEST_F(Plc, MotorAndSystemAreAddressedByEachForItself) {
  load(1, {"Q1=Q1+1", "ADDRESS#3&2", "Q2=Q2+1"});
  load(2, {"Q3=Q3+1"});
  ASSERT_EQ(host("I5=2 ENABLE PLC 1,2 &5"), "");
  background(4);
  EXPECT_EQ(q_variable_read(0, 1), 1.0) << "&1 is the default";
  EXPECT_EQ(q_variable_read(1, 1), 1.0) << "the address stays from scan to scan";
  EXPECT_EQ(q_variable_read(1, 2), 2.0);
  EXPECT_EQ(q_variable_read(0, 3), 2.0) << "it is that of PLC 1 alone";
  EXPECT_EQ(q_variable_read(4, 3), 0.0) << "the host's address means nothing";
  ASSERT_EQ(host("DISABLE PLC 1 ENABLE PLC 1"), "");
  background(2);
  EXPECT_EQ(q_variable_read(0, 1), 2.0) << "&1 again";
}

// firmware:7.2/3: the P-variable's value when the statement is executed; one that names nothing changes nothing.
TEST_F(Plc, AddressesAreTakenFromVariables) {
  load(1, {"ADDRESS&P401", "Q1=Q1+1", "P401=P401+1"});
  load(2, {"ADR#P400&P401", "CMDP\"#\"", "DISABLE PLC 2"});
  ASSERT_EQ(host("I3=2 P401=2 I5=2 ENABLE PLC 1"), "");
  background(3);
  ASSERT_EQ(host("DISABLE PLC 1"), "");
  for (unsigned cs = 1; cs <= 6; ++cs) EXPECT_EQ(q_variable_read(cs - 1, 1), cs >= 2 && cs <= 4 ? 1.0 : 0.0) << cs;
  const auto motor_of = [](const std::string& value) {
    EXPECT_EQ(host("P400=" + value + " ENABLE PLC 2"), "");
    background(3);
    return platform::sent();
  };
  EXPECT_EQ(motor_of("32"), "32\r");
  EXPECT_EQ(motor_of("1"), "1\r");
  for (const char* none : {"0", "33", "0.9", "-1", "1000000000"}) EXPECT_EQ(motor_of(none), "1\r") << none;
  EXPECT_EQ(motor_of("3.99"), "3\r") << "the whole part";
  ASSERT_EQ(host("Q2=0"), "");
  load(3, {"ADR&P402", "Q2=Q2+1"});
  for (const char* value : {"16", "17", "1", "0", "0.9", "16.9", "-1"}) {
    ASSERT_EQ(host(std::string("DISABLE PLC 3 P402=") + value + " ENABLE PLC 3"), "");
    background(1);
  }
  EXPECT_EQ(q_variable_read(15, 2), 2.0) << "16 and 16.9";
  EXPECT_EQ(q_variable_read(0, 2), 5.0) << "&1 is what it is without";
}

// Y:$3100 to Y:$311F: bit 22 of each that does not run, from a start on.
TEST_F(Plc, EachPlcHasItsWordOfStatus) {
  for (const int n : {0, 3, 31}) load(n, {"P1=P1+1"});
  ASSERT_EQ(host("SAVE"), "");
  const auto expect_running = [](std::uint32_t plcs) {
    for (unsigned n = 0; n < 32; ++n) EXPECT_EQ(*hal_y(0x3100 + n), (plcs >> n & 1u) != 0 ? 0u : 1u << 22) << n;
    EXPECT_EQ(plc_enabled(), plcs);
  };
  expect_running(0);
  for (unsigned n = 0; n < 32; ++n) *hal_y(0x3100 + n) = 0x123;  // what a host has left there
  platform::reset("$$$");
  expect_running(1u << 0 | 1u << 3 | 1u << 31);
  ASSERT_EQ(host("DISABLE PLC 3 PAUSE PLC 31"), "");
  expect_running(1u << 0);
  ASSERT_EQ(host("RESUME PLC 3,31"), "");
  expect_running(1u << 0 | 1u << 31);
  ASSERT_EQ(host("DISABLE PLC 0..31 ENABLE PLC 1..2"), "");
  expect_running(1u << 1 | 1u << 2);
}

// What a PLC was in the middle of at a reset, and whom it had addressed, is nothing of the new start.
TEST_F(Plc, BeginsAnewBehindAReset) {
  load(1, {"P3=P3+1", "ADDRESS#3&2", "WHILE(P4=0)", "Q1=Q1+1", "ENDWHILE", "P5=5"});
  load(2, {"Q2=Q2+1"});
  ASSERT_EQ(host("I5=2 SAVE ENABLE PLC 1,2"), "");
  background(3);
  ASSERT_EQ(host("P3"), "1");
  platform::reset("$$$");
  ASSERT_EQ(host("P3=0 P4=1 &1Q1=0 &2Q1=0 Q2=0 &1Q2=0"), "");
  background(1);
  EXPECT_EQ(host("P3 P5"), "1|5") << "PLC 1 is the first, from its top";
  background(1);
  EXPECT_EQ(q_variable_read(0, 2), 1.0) << "PLC 2 is of &1";
}

TEST_F(Plc, WhatIsEnabledAfterOpenCloseSaveAndReset) {
  load(1, {"P1=P1+1"});
  load(2, {"P2=P2+1"});
  ASSERT_EQ(host("I5=2"), "");
  background(3);
  EXPECT_EQ(host("P1 P2"), "0|0") << "a new one is disabled";
  ASSERT_EQ(host("ENABLE PLC 1,2"), "");
  ASSERT_EQ(host("OPEN PLC 1"), "");
  plc_enable(1u << 1);  // as another port would
  background(2);
  EXPECT_EQ(p(1), 0.0) << "it is open";
  ASSERT_EQ(host("P3=1"), "");
  ASSERT_EQ(host("CLOSE"), "");
  background(2);
  EXPECT_EQ(host("P1 P3"), "1|1");
  ASSERT_EQ(host("DISABLE PLC 1,2 P1=0 P2=0 SAVE"), "");
  background(2);
  EXPECT_EQ(plc_enabled(), 0u) << "SAVE changes nothing";
  platform::reset("$$$");
  EXPECT_EQ(plc_enabled(), 6u) << "all that were saved";
  background(3);
  EXPECT_EQ(host("P1 P2"), "2|1");
  platform::reset("$$$***");
  EXPECT_EQ(plc_enabled(), 0u);
}

// Opening PLC 2 moves the words of PLC 3, which stands in a loop.
TEST_F(Plc, PlcGoesOnWhenProgramsMove) {
  load(2, {"P1=P1+1"});
  load(3, {"P3=P3+1", "WHILE(P4=0)", "P5=P5+1", "ENDWHILE", "P6=P6+1"});
  ASSERT_EQ(host("I5=2 ENABLE PLC 3"), "");
  background(2);
  ASSERT_EQ(host("P3 P5 P6"), "1|2|0");
  ASSERT_EQ(host("OPEN PLC 2"), "");
  ASSERT_EQ(host("P7=1"), "");
  ASSERT_EQ(host("CLOSE"), "");
  background(1);
  EXPECT_EQ(host("P3 P5 P6"), "1|3|0");
  ASSERT_EQ(host("P4=1"), "");
  background(1);
  EXPECT_EQ(host("P3 P5 P6"), "1|3|1");
}

TEST_F(Plc, ControlDDisablesAll) {
  load(0, {"P1=P1+1"});
  load(9, {"P2=P2+1"});
  ASSERT_EQ(host("I5=3 ENABLE PLC 0,9"), "");
  background(1);
  servo_ticks(3);
  ASSERT_EQ(host("P1 P2"), "1|1");
  host_port_character(0x04);
  platform::real_time();
  EXPECT_EQ(plc_enabled(), 0u) << "without the background";
  servo_ticks(9);
  background(3);
  EXPECT_EQ(host("P1 P2"), "1|1");
  EXPECT_FALSE(shown_running(0));
}

TEST_F(Plc, DamagedStatementDisablesItsPlcAlone) {
  load(1, {"P1=P1+1", "P2=P2+1"});
  load(2, {"P3=P3+1"});
  ASSERT_EQ(host("I5=2 ENABLE PLC 1,2"), "");
  background(2);
  // PLC 1 lies lowest: its second statement, an axis move, which no PLC has.
  const fixed_program* program = fixed_program_find(FIXED_PLC, 1);
  const instruction in{OP_AXIS, 0, AXIS_X, 5.0};
  user_memory_write(program->base + program->words / 2, word_encode(&in) | WORD_START_OF_LINE);
  background(6);
  EXPECT_EQ(host("P1..3"), "2|1|6");
  EXPECT_FALSE(shown_running(1));
  EXPECT_TRUE(shown_running(2));
}

TEST_F(Plc, UnfinishedBlockOfAClosedPlcDoesNotRunAway) {
  ASSERT_EQ(host("OPEN PLC 1 CLEAR"), "");
  ASSERT_EQ(host("P1=P1+1"), "");
  ASSERT_EQ(host("WHILE(P2=0)"), "");
  ASSERT_EQ(host("P3=P3+1"), "");
  ASSERT_EQ(host("CLOSE"), "ERR009");
  ASSERT_EQ(host("I5=2 ENABLE PLC 1"), "");
  background(4);
  EXPECT_LE(p(3), 4.0);
}

TEST_F(Plc, ReturnEndsTheScan) {
  load(1, {"P1=P1+1", "IF(P1>2)", "RETURN", "ENDIF", "P2=P2+1"});
  ASSERT_EQ(host("I5=2 ENABLE PLC 1"), "");
  background(5);
  EXPECT_EQ(host("P1 P2"), "5|2");
}

// A variable has 36 bits of 0.1, and so has the constant (firmware:1.2/6).
TEST_F(Plc, AConstantIsEqualToTheVariableThatKeepsIt) {
  load(1, {"P1=0.1", "P2=0", "IF(P1=0.1)", "AND(M1=-1234.567)", "P2=1", "ENDIF", "IF(P1<0.1)", "P2=2", "ENDIF",
           "IF(P1>0.1)", "P2=3", "ENDIF"});
  ASSERT_EQ(host("M1->L:$10F0 M1=-1234.567 I5=2 ENABLE PLC 1"), "");
  background(1);
  EXPECT_EQ(p(2), 1.0);
}

// One ms from variable to variable: PLCs have a turn every 5 ms, as between lines of an answer (firmware:8.3/6).
TEST_F(Plc, GoOnWhileALineAssignsManyVariables) {
  load(1, {"P8000=P8000+1"});
  ASSERT_EQ(host("I5=2 ENABLE PLC 1"), "");
  for (const char* line : {"I8000..8191=$78000", "I100,192=*", "P0..191=1", "M0..191->*", "M0..191->"}) {
    ASSERT_EQ(host("P8000=0"), "");
    fake_hal_set_look(hal_cycles_per_ms());
    (void)host(line);
    fake_hal_set_look(100);
    EXPECT_GE(p(8000), 192 / 8) << line;
    EXPECT_LE(p(8000), 192 / 5) << line;
  }
}

// Isx11 loses one a servo interrupt: 30 of them are over after 30 (firmware:8.1).
TEST_F(Plc, TimerHoldsALoop) {
  load(1, {"P1=P1+1", "I5111=30", "WHILE(I5111>0)", "ENDWHILE", "P2=P2+1", "I5212=12", "WHILE(I5212>0)", "ENDWHILE",
           "P3=P3+1", "DISABLE PLC 1"});
  ASSERT_EQ(host("I5=2 ENABLE PLC 1"), "");
  unsigned first = 0, second = 0;
  for (unsigned tick = 0; tick < 60; ++tick) {
    background(1);
    if (first == 0 && p(2) > 0.0) first = tick;
    if (second == 0 && p(3) > 0.0) second = tick;
    servo_ticks(1);
  }
  EXPECT_EQ(first, 30u);
  EXPECT_EQ(second, 42u);
  EXPECT_EQ(host("P1..3"), "1|1|1");
}

// firmware:7.2/3: whoever finds a lock free has it; the others wait until it is let go.
TEST_F(Plc, ALockHasOneHolderAtATime) {
  load(1,
       {"P1=1", "WHILE(P1=1)", "LOCK4,P1", "ENDWHILE", "P11=P11+1", "WHILE(P9=0)", "ENDWHILE", "UNLOCK4", "DISPLC1"});
  load(2, {"P2=1", "WHILE(P2=1)", "LOCK 4, P2", "ENDWHILE", "P12=P12+1", "DISPLC2"});
  ASSERT_EQ(host("I5=2 ENABLE PLC 1,2"), "");
  background(20);
  EXPECT_EQ(host("P1..2 P11..12 I4904"), "0|1|1|0|$101") << "bit 8 is lock 4, bit 0 the RAM";
  ASSERT_EQ(host("P9=1"), "");
  background(20);
  EXPECT_EQ(host("P1..2 P11..12 I4904"), "0|0|1|1|$101") << "PLC 2 has it now";
  EXPECT_EQ(host("LOCK4,P3 P3 LOCK5,P4 P4 I4904"), "1|0|$301");
  EXPECT_EQ(host("UNLOCK4 UNLOCK5 UNLOCK7 LOCK7,P8191 P8191 I4904"), "0|$801");
  for (const char* wrong :
       {"LOCK8,P1", "LOCK-1,P1", "LOCK1", "LOCK1,8", "LOCK1,P8192", "UNLOCK8", "UNLOCK", "LOCK1.5,P1"})
    EXPECT_EQ(host(wrong), "ERR003") << wrong;
  platform::reset();
  EXPECT_EQ(host("I4904"), "$1") << "a reset frees all";
}

TEST_F(Plc, ALockIsListedAsItIsEntered) {
  load(3, {"LOCK0,P0", "lock 7 , p8191", "UNLOCK7", "LOCK 3"});
  EXPECT_EQ(host("LIST PLC 3"), "LOCK0,P0|LOCK7,P8191|UNLOCK7|LOCK3|RET");
  ASSERT_EQ(host("OPEN PLC 3"), "");
  for (const char* wrong : {"LOCK8,P1", "LOCK1,P8192", "LOCK1,Q1", "LOCK1,", "LOCK(1),P1"})
    EXPECT_EQ(host(wrong), "ERR003") << wrong;
}

}  // namespace
