// Status words, time base, timers, targets and axis definitions at their addresses (firmware:1.10), read through the
// M-variables that the published definition files have for them, against what `? ?? ???` answer.
#include <cstdio>
#include <string>
#include <utility>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_platform/fake_hal.h"
#include "testbench/unit/firmware_program/platform.h"

extern "C" {
#include "firmware/motion/average_velocity.h"
#include "firmware/motion/motor.h"
}

extern "C" {
#include "firmware/base/status.h"
#include "firmware/kernel/tasks.h"
}

namespace {

using platform::host;

class LiveWords : public FirmwareTest {
 protected:
  static std::string m(const std::string& definition) { return host("M1->" + definition + " M1"); }
};

// firmware:5.2, one variable after the other; an idle motor shows an open loop (18) and Ixx34 (16).
TEST_F(LiveWords, MotorStatusBitsFollowTheirVariables) {
  EXPECT_EQ(host("#1?"), "850000000000") << "activated, open loop, integration mode";
  EXPECT_EQ(host("#2?"), "050000000000");
  const std::pair<const char*, unsigned> causes[] = {
      {"00=1", 23}, {"34=1", 16}, {"59=2", 9}, {"59=1", 8}, {"01=2", 7}, {"01=1", 6},
      {"06=2", 5},  {"06=1", 4},  {"97=2", 3}, {"97=1", 2}, {"96=2", 1}, {"96=1", 0},
  };
  for (const unsigned motor : {1u, 7u, 32u}) {
    const std::string n = std::to_string(motor);
    char address[8];
    std::snprintf(address, sizeof address, "$%X", 0xB0 + 0x80 * (motor - 1));
    host("I" + n + "00=0 I" + n + "34=0");
    EXPECT_EQ(host("#" + n + "?"), "040000000000");
    for (const auto& [assignment, bit] : causes) {
      const std::string variable = std::string(assignment).substr(0, 3);
      host("I" + n + assignment);
      char expected[16];
      std::snprintf(expected, sizeof expected, "%06X", 0x040000u | 1u << bit);
      EXPECT_EQ(host("#" + n + "?").substr(0, 6), expected) << assignment;
      EXPECT_EQ(m("X:" + std::string(address) + "," + std::to_string(bit)), "1") << assignment;
      host("I" + n + variable + "0");
      EXPECT_EQ(m("X:" + std::string(address) + "," + std::to_string(bit)), "0") << assignment;
    }
    host("I" + std::to_string(3300 + 50 * (motor - 1)) + "=1");
    EXPECT_EQ(host("#" + n + "?"), "140000000000");
  }
}

// firmware:5.3: system in 23..20, axis in 19..16, bit 15.
TEST_F(LiveWords, MotorStatusTellsTheAxis) {
  const std::pair<const char*, const char*> cases[] = {
      {"&1#5->100A", "018000"}, {"&2#5->100B", "128000"},  {"&16#5->100C", "F38000"}, {"&1#5->10U", "048000"},
      {"&1#5->2W", "048000"},   {"&3#5->1000X", "278000"}, {"&1#5->2X-3Y", "078000"}, {"&1#5->5Z+7", "078000"},
      {"&1#5->I", "058000"},    {"&9#5->-1V", "848000"},
  };
  for (const auto& [definition, word] : cases) {
    EXPECT_EQ(host(definition), "");
    EXPECT_EQ(host("#5?").substr(6), word) << definition;
    EXPECT_EQ(std::stoul(host("RHY$2C0"), nullptr, 16), std::stoul(word, nullptr, 16)) << definition;
    host("UNDEFINE ALL");
    EXPECT_EQ(host("#5? RHY$2C0"), "050000000000|0");
  }
}

TEST_F(LiveWords, AxisScalesAndOffset) {
  host("&1#2->100X+20.5Y-0.25Z+7");
  EXPECT_EQ(m("L:$14F"), "100");
  EXPECT_EQ(m("L:$150"), "20.5");
  EXPECT_EQ(m("L:$151"), "-0.25");
  EXPECT_EQ(m("L:$152"), "7");
  host("&1#3->5B #4->3V #32->-2W-1.5");
  EXPECT_EQ(host("RL$1CF,4"), "5 0 0 0");
  EXPECT_EQ(host("RL$24F,4"), "0 3 0 0");
  EXPECT_EQ(host("RL$104F,4"), "0 0 -2 -1.5");
  EXPECT_EQ(host("WL$14F,1 RL$14F"), "100") << "made by the definition";
}

// firmware:5.4, firmware:5.5: bits 0 (runs) and 4 (continuous) of word 1, 17 (in position) of word 2; targets in L:+$41
// on.
TEST_F(LiveWords, CoordinateSystemShowsItsProgram) {
  const auto agree = [](const std::string& n, const std::string& base) {
    const std::string status = host("&" + n + "??");
    for (unsigned word = 0; word < 3; ++word) {
      const std::string address = base + (word == 1 ? "3F" : "40"), half = word == 0 ? "RHX$" : "RHY$";
      EXPECT_EQ(std::stoul(host(half + address), nullptr, 16), std::stoul(status.substr(6 * word, 6), nullptr, 16))
          << status << " " << word;
    }
  };
  agree("1", "20");
  agree("16", "2F");
  ASSERT_EQ(host("&3 I68=15 DEF ROT 200 B0 OPEN ROT"), "");
  ASSERT_EQ(host("TM100 TA40 TS0"), "");
  ASSERT_EQ(host("X7.5 A-2 Z3"), "");
  ASSERT_EQ(host("CLOSE"), "");
  EXPECT_EQ(host("M1->X:$2240,0 M2->Y:$223F,17 M3->L:$2247 M1..3"), "0|1|0");
  ASSERT_EQ(host("R"), "");
  platform::servo_ticks(30);
  agree("3", "22");
  EXPECT_EQ(host("M1..3"), "1|0|7.5") << "runs, not in position, target of X";
  EXPECT_EQ(m("X:$2240,4"), "1");
  EXPECT_EQ(host("RL$2241,9"), "-2 0 0 0 0 0 7.5 0 3");
  EXPECT_EQ(host("RL$2141,9"), "0 0 0 0 0 0 0 0 0") << "the next one stands";
  platform::servo_ticks(2000);
  EXPECT_EQ(host("RL$2241,9"), "-2 0 0 0 0 0 7.5 0 3");
  EXPECT_EQ(host("Q"), "");
  platform::servo_ticks(10);
  agree("3", "22");
  EXPECT_EQ(host("M1->X:$2240,0 M1..2"), "0|1");
}

// X10 and X20 follow without a gap: when `/` ends the first, the second is calculated and waits.
TEST_F(LiveWords, AMoveThatWaitsIsNoTarget) {
  ASSERT_EQ(host("&1 DEF ROT 200 B0 OPEN ROT"), "");
  for (const char* line : {"TM500", "X10", "X20", "X30"}) ASSERT_EQ(host(line), "");
  ASSERT_EQ(host("CLOSE R"), "");
  platform::servo_ticks(30);
  EXPECT_EQ(host("RL$2047"), "10");
  ASSERT_EQ(host("/"), "");
  platform::servo_ticks(1800);  // 0.44 ms each
  EXPECT_TRUE(coordinate_systems[0].next_valid) << "nothing waits: the test shows nothing";
  EXPECT_EQ(host("RL$2047"), "10");
  ASSERT_EQ(host("R"), "");
  platform::servo_ticks(30);
  EXPECT_EQ(host("RL$2047"), "20");
}

TEST_F(LiveWords, DwellShowsInTheMotorsOfTheSystem) {
  host("&1#1->X &2#2->X I124=$100001");
  motors[0].loop = LOOP_CLOSED;
  ASSERT_EQ(host("&1 DEF ROT 100 B0 OPEN ROT"), "");
  ASSERT_EQ(host("DWELL500"), "");
  ASSERT_EQ(host("CLOSE R"), "");
  platform::servo_ticks(30);
  EXPECT_EQ(m("X:$B0,15"), "1");
  EXPECT_EQ(m("X:$130,15"), "0");
  EXPECT_EQ(m("X:$1B0,15"), "0") << "in no coordinate system";
  platform::servo_ticks(2000);
  EXPECT_EQ(m("X:$B0,15"), "0");
}

// 100 % is I10, 2^-23 ms; Isx94 is added each servo cycle.
TEST_F(LiveWords, TimeBase) {
  EXPECT_EQ(host("RX$2000 RX$2002"), "3713991|3713991");
  ASSERT_EQ(host("I5194=1000"), "");
  ASSERT_EQ(host("%50"), "");
  EXPECT_EQ(m("X:$2000,24,S"), "1856996");  // 1856995.5
  platform::servo_ticks(3);
  EXPECT_EQ(m("X:$2002,24,S"), std::to_string(3713991 - 3000));
  EXPECT_EQ(host("RX$2100 RX$2102"), "3713991|3713991");
}

// firmware:1.10/9: the commanded one is written by programs that override the feed rate, in units of I10.
TEST_F(LiveWords, CommandedTimeBaseIsWritten) {
  ASSERT_EQ(host("I5194=1000 I5294=2000 M1->X:$2000,24,S M2->X:$2100,24,S"), "");
  EXPECT_EQ(host("M1=3711991 M2=3715991 M1 M2"), "3711991|3715991");
  platform::servo_ticks(1);
  EXPECT_EQ(host("RX$2002 RX$2102"), "3712991|3715991") << "slewed at Isx94";
  platform::servo_ticks(2);
  EXPECT_EQ(host("RX$2002 RX$2102 RX$2202"), "3711991|3715991|3713991");
  ASSERT_EQ(host("I5194=8388607 WX$2000,0"), "");
  platform::servo_ticks(1);
  EXPECT_EQ(host("RX$2002 &1%"), "0|0");
  ASSERT_EQ(host("WX$2000,$7FFFFF"), "");
  platform::servo_ticks(1);
  EXPECT_EQ(host("RX$2000 RX$2002"), "8388607|8388607") << "2^23 - 1 of 3713991: 225.87 %";
  ASSERT_EQ(host("WX$2000,$800000"), "");
  platform::servo_ticks(1);
  EXPECT_EQ(host("RX$2000 RX$2002"), "0|0") << "below 0";
  EXPECT_EQ(host("WX$2002,5 RX$2002"), "0") << "the present one follows";
  EXPECT_EQ(host("WX$2000,$123456 M3->X:$2000,4,8 M3=$FF RHX$2000"), "123FF6") << "a part of the word";
  EXPECT_EQ(host("WY$2000,7 RY$2000 RHX$2000"), "7|123FF6") << "an ordinary word";
  EXPECT_EQ(host("WX$2F00,2000000 RX$2F00 RX$2000"), "2000000|1196022") << "that of system 16";
}

// While H holds a system its word is kept for the end of the hold, as what % commands is.
TEST_F(LiveWords, CommandedTimeBaseOfAHeldSystemWaitsForItsEnd) {
  ASSERT_EQ(host("&1 I5194=8388607 I5195=8388607 DEF ROT 100 B0 OPEN ROT"), "");
  ASSERT_EQ(host("TM1000 X10"), "");
  ASSERT_EQ(host("CLOSE R"), "");
  platform::servo_ticks(10);
  ASSERT_EQ(host("H"), "");
  platform::servo_ticks(1);
  ASSERT_EQ(host("WX$2000,1000000"), "");
  platform::servo_ticks(3);
  EXPECT_EQ(host("RX$2000 RX$2002"), "1000000|0");
  ASSERT_EQ(host("R"), "");
  platform::servo_ticks(1);
  EXPECT_EQ(host("RX$2002"), "1000000");
}

TEST_F(LiveWords, TimersAreReadAndSet) {
  ASSERT_EQ(host("I6611=1000 I6612=-5"), "");
  platform::servo_ticks(10);
  EXPECT_EQ(host("RX$2F15 RY$2F15"), "990|-15");
  EXPECT_EQ(host("M1->X:$2F15,24,S M2->Y:$2F15,24,S M1=50 M2=60 I6611..6612"), "50|60");
  platform::servo_ticks(10);
  EXPECT_EQ(host("M1 M2"), "40|50");
}

TEST_F(LiveWords, PartOfATimerIsSet) {
  ASSERT_EQ(host("I6611=$123456 M1->X:$2F15,4,8 M1=$FF"), "");
  EXPECT_EQ(host("RHX$2F15"), "123FF6");
}

// The servo count comes round after 2^32 interrupts: as long as none begins again what has run down does not either.
TEST_F(LiveWords, TimersThatHaveRunDownStayThere) {
  constexpr unsigned kBegan = 12'000, kLook = 256;
  platform::servo_ticks(kBegan);
  ASSERT_EQ(host("I6611=1000 I6612=5"), "");
  tasks_initialize();  // 2^32 - kBegan interrupts later
  EXPECT_EQ(host("I6611..6612"), "-8388608|-8388608");
  for (unsigned timer = 0; timer < 2 * COORDINATE_SYSTEMS; ++timer) {
    platform::servo_ticks(kLook);
    platform::background(1);
  }
  platform::servo_ticks(kBegan + 10 - 2 * COORDINATE_SYSTEMS * kLook);
  EXPECT_EQ(host("I6611..6612"), "-8388608|-8388608");
  ASSERT_EQ(host("I6611=1000"), "");
  platform::servo_ticks(10);
  EXPECT_EQ(host("I6611..6612"), "990|-8388608");
}

// firmware:1.5: a lock is about assignments to I-variables; these are writes of memory.
TEST_F(LiveWords, TimersAreSetWhileTheirVariablesAreLocked) {
  ASSERT_EQ(host("I6611=7 I6612=8 I41=2"), "");
  EXPECT_EQ(host("I6611=1 I6612=1 I6611..6612"), "7|8");
  EXPECT_EQ(host("WX$2F15,50 WY$2F15,60 I6611..6612"), "50|60");
  EXPECT_EQ(host("M1->X:$2F15,24,S M1=70 I6611"), "70");
}

TEST_F(LiveWords, GlobalStatus) {
  EXPECT_EQ(host("??? RHX$6 RHY$6"), "000000000800|0|800");
  ASSERT_EQ(host("DEF ROT 20 OPEN ROT"), "");
  EXPECT_EQ(host("RHY$6"), "C0800") << "bits 19 and 18, on the next line already";
  host("CLOSE");
  status_set(STATUS_REAL_TIME_REENTRY | STATUS_REAL_TIME_WARNING | STATUS_FLASH_ERROR);
  EXPECT_EQ(m("X:$6,22"), "1");
  EXPECT_EQ(host("M1=0 ???"), "000600000800") << "what stays can be cleared, bit by bit";
  EXPECT_EQ(host("WX$6,0 WY$6,0 ???"), "000400000800") << "the cause of the other is still there";
  EXPECT_EQ(host("WX$6,$FFFFFF ???"), "000400000800");
}

// Bits 23 and 16 of word 2 are of one product each.
TEST_F(LiveWords, GlobalStatusTellsTheProduct) {
  const std::pair<unsigned, std::string> products[] = {
      {HAL_PRODUCT_ULTRALITE, "800800"}, {HAL_PRODUCT_UMAC, "10800"}, {HAL_PRODUCT_JPAN, "800"}, {0, "800"}};
  for (const auto& [product, word] : products) {
    fake_hal_set_strap(HAL_STRAP_PRODUCT, product);
    EXPECT_EQ(host("RHY$6"), word) << product;
  }
}

// firmware:5.4, firmware:5.5: what is calculated and waits counts as what executes does, and is shown as such.
TEST_F(LiveWords, StatusTellsBlendedMovesAndThoseThatWait) {
  ASSERT_EQ(host("&1 DEF ROT 100 B0 OPEN ROT M1->X:$2040,2 M2->Y:$203F,12 M3->Y:$203F,17"), "");
  for (const char* line : {"TM200 TA100 TS0 X1", "X2", "DWELL500", "X3", "X4", "X5", "CLOSE", "R"})
    ASSERT_EQ(host(line), "") << line;
  platform::servo_ticks(30);
  EXPECT_EQ(host("M1..3"), "0|0|0") << "X1 from rest, X2 waits";
  platform::servo_ticks(470);  // 200 ms are 452 cycles
  EXPECT_EQ(host("M1..3"), "1|1|0") << "X2 blended, DWELL waits";
  platform::servo_ticks(700);  // X2 ends 500 ms after the start, 1129 cycles
  EXPECT_EQ(host("M1..3"), "0|1|0") << "DWELL";
  platform::servo_ticks(1200);
  ASSERT_EQ(host("/"), "");
  platform::servo_ticks(2000);
  EXPECT_EQ(host("PR M1..3"), "1|0|0|0") << "X3 has ended, X4 waits for R";
}

TEST_F(LiveWords, AProgramThatHasEndedAsksForNothing) {
  for (const char* line : {"OPEN PROG 1 CLEAR", "TM40 TA0 TS0 X1", "X2", "CLOSE", "&1B1R"})
    ASSERT_EQ(host(line), "") << line;
  platform::servo_ticks(6);
  EXPECT_EQ(host("??").substr(0, 6), "A80039") << "runs, continuous, moves by time";
  platform::servo_ticks(120);  // 54 ms
  EXPECT_EQ(host("??").substr(0, 6), "A8003C") << "X2 executes, it began blended, and nothing is left to calculate";
  platform::servo_ticks(100);
  EXPECT_EQ(host("??").substr(0, 6), "A80028") << "moves by time";
}

// firmware:5.9: eight motors by the last ##n, each report its own word.
TEST_F(LiveWords, EightMotorsAreThoseOfTheGroup) {
  const auto control = [](char c) {
    host_port_character(static_cast<std::uint8_t>(c));
    platform::background(1);
    return platform::sent();
  };
  ASSERT_EQ(host("I3=2 M1->D:$8B M2->D:$48B M5->D:$88 M6->D:$488"), "");
  ASSERT_EQ(host("M1=3072*5 M2=3072*6 M5=3072*14 M6=3072*18 I60=0 I61=0 I900=1"), "");
  ASSERT_EQ(host("I109=48"), "");  // what is reported is in counts, whatever Ixx09 is
  motors_active = 0x101;
  motors[0].actual += 3072 * 7;
  motors[8].actual += 3072 * 8;
  average_velocity_servo();  // one sample

  const std::string others = " 0 0 0 0 0 0 0\r\x06", idle = " 050000000000";
  EXPECT_EQ(control(0x10), "5" + others);
  EXPECT_EQ(control(0x16), "7" + others);
  EXPECT_EQ(control(0x06), "9" + others);
  EXPECT_EQ(control(0x02).substr(0, 25), "850000000000" + idle);
  ASSERT_EQ(host("##1"), "");
  EXPECT_EQ(control(0x10), "6" + others);
  EXPECT_EQ(control(0x16), "8" + others);
  EXPECT_EQ(control(0x06), "12" + others);
  EXPECT_EQ(control(0x02).substr(0, 25), "850000000000" + idle);
  ASSERT_EQ(host("##3"), "");
  EXPECT_EQ(control(0x10), "0" + others);
}

// firmware:4.10/5, firmware:4.10/7: % slews at Isx94, a hold and its end at Isx95.
TEST_F(LiveWords, AHoldAndItsEndSlewAtIsx95) {
  ASSERT_EQ(host("&1 I5194=1000 I5195=2000 DEF ROT 100 B0 OPEN ROT"), "");
  for (const char* line : {"TM60000 X10", "CLOSE", "R"}) ASSERT_EQ(host(line), "") << line;
  platform::servo_ticks(10);
  ASSERT_EQ(host("H"), "");
  platform::servo_ticks(5);
  EXPECT_EQ(host("RX$2002"), std::to_string(3713991 - 5 * 2000));
  ASSERT_EQ(host("R"), "");
  platform::servo_ticks(3);
  EXPECT_EQ(host("RX$2002"), std::to_string(3713991 - 2 * 2000));
  ASSERT_EQ(host("%50"), "");
  platform::servo_ticks(2);
  EXPECT_EQ(host("RX$2002"), std::to_string(3713991 - 2 * 2000 - 2 * 1000));
}

}  // namespace
