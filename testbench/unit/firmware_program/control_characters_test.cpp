// What each control character does, to which systems and motors (firmware:5.9), one after the other on systems that
// run.
#include <sstream>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_program/platform.h"

extern "C" {
#include "firmware/command/control_characters.h"
}

namespace {

using platform::host;

constexpr unsigned kSystems = 16;

class ControlCharacters : public FirmwareTest {
 protected:
  // Four moves of so many milliseconds for each system, which stand at the first.
  static void point_all(unsigned tm) {
    ASSERT_EQ(host("OPEN PROG 1 CLEAR TM" + std::to_string(tm) + " TA10 TS0"), "");
    for (const char* line : {"X1", "X2", "X3", "X4"}) ASSERT_EQ(host(line), "");
    ASSERT_EQ(host("CLOSE"), "");
    for (unsigned cs = 1; cs <= kSystems; ++cs) ASSERT_EQ(host("&" + std::to_string(cs) + "B1"), "");
  }
  static void run_all() {
    point_all(1000);
    for (unsigned cs = 1; cs <= kSystems; ++cs) ASSERT_EQ(host("&" + std::to_string(cs) + "R"), "");
    platform::servo_ticks(30);
    ASSERT_EQ(running(), 0xFFFFu);
  }
  static unsigned running() {
    unsigned mask = 0;
    for (unsigned cs = 0; cs < kSystems; ++cs) mask |= run_is_running(cs) ? 1u << cs : 0u;
    return mask;
  }
  // The words of the one line that it reports.
  static std::vector<std::string> words_of(char letter) {
    platform::sent();
    EXPECT_TRUE(control_character(static_cast<std::uint8_t>(letter - '@'))) << letter;
    std::string text;
    for (const char c : platform::sent()) text += c == '\r' || c == '\n' ? "" : std::string(1, c);
    std::istringstream in(text);
    std::vector<std::string> words;
    for (std::string word; in >> word;) words.push_back(word);
    return words;
  }
  static void give(char letter) {
    platform::sent();
    EXPECT_FALSE(control_character(static_cast<std::uint8_t>(letter - '@'))) << letter;
    EXPECT_EQ(platform::sent(), "") << letter;
  }
  static double x(unsigned cs) { return coordinate_systems[cs].position[AXIS_X]; }
};

TEST_F(ControlCharacters, AAndKAbortAllSystems) {
  for (const char letter : {'A', 'K'}) {
    platform::power_up();
    run_all();
    give(letter);
    EXPECT_EQ(running(), 0u) << letter;
    platform::servo_ticks(6);
    for (unsigned cs = 0; cs < kSystems; ++cs) {
      EXPECT_FALSE(coordinate_systems[cs].active) << letter << cs;
      EXPECT_LT(x(cs), 1.0) << "in the middle of its move";
    }
  }
}

// What stops things does so in the next real-time task, whatever the background is at (firmware:6.1/3).
TEST_F(ControlCharacters, StopsActBeforeTheBackgroundComesToThem) {
  for (const char letter : {'A', 'K', 'O', 'Q', 'D'}) {
    SCOPED_TRACE(letter);
    platform::power_up();
    run_all();
    ASSERT_EQ(host("OPEN PLC 1 CLEAR P1=P1+1 CLOSE I5=2 ENABLE PLC 1"), "");
    host_port_character(static_cast<std::uint8_t>(letter - '@'));
    EXPECT_TRUE(hal_real_time_pending());
    platform::real_time();
    EXPECT_EQ(running(), letter == 'A' || letter == 'K' ? 0u : 0xFFFFu);
    for (unsigned cs = 0; cs < kSystems; ++cs) {
      EXPECT_EQ(coordinate_systems[cs].held, letter == 'O') << cs;
      EXPECT_EQ(coordinate_systems[cs].quit, letter == 'Q') << cs;
    }
    EXPECT_EQ(plc_enabled(), letter == 'D' ? 0u : 1u << 1);
  }
}

TEST_F(ControlCharacters, OHoldsAllSystemsAndRunGoesOn) {
  run_all();
  give('O');
  platform::servo_ticks(2300);  // I10 / Isx95 = 3713991 / 1644 = 2259
  EXPECT_EQ(running(), 0xFFFFu) << "held, not stopped";
  for (unsigned cs = 0; cs < kSystems; ++cs) {
    EXPECT_TRUE(coordinate_systems[cs].held) << cs;
    EXPECT_FALSE(coordinate_systems[cs].quit) << cs;
    EXPECT_EQ(coordinate_systems[cs].increment, 0) << cs;
  }
  const auto elapsed = coordinate_systems[15].elapsed;
  platform::servo_ticks(300);
  EXPECT_EQ(coordinate_systems[15].elapsed, elapsed);
  for (unsigned cs = 1; cs <= kSystems; ++cs) ASSERT_EQ(host("&" + std::to_string(cs) + "R"), "");
  platform::servo_ticks(15000);
  EXPECT_EQ(running(), 0u);
  for (unsigned cs = 0; cs < kSystems; ++cs) EXPECT_EQ(x(cs), 4.0) << "nothing was lost";
}

TEST_F(ControlCharacters, QQuitsAllProgramsBehindWhatIsCalculated) {
  run_all();
  give('Q');
  platform::servo_ticks(6000);
  EXPECT_EQ(running(), 0u);
  for (unsigned cs = 0; cs < kSystems; ++cs) {
    EXPECT_EQ(x(cs), 2.0) << "the executing move and the next";
    EXPECT_EQ(coordinate_systems[cs].increment, platform::kDefaultI10) << "not held";
  }
}

TEST_F(ControlCharacters, RAndSRunTheSystemsThatI68MakesActive) {
  for (const char letter : {'R', 'S'})
    for (const unsigned i68 : {0u, 1u, 7u, 14u, 15u}) {
      platform::power_up();
      point_all(100);
      ASSERT_EQ(host("I68=" + std::to_string(i68)), "");
      give(letter);
      EXPECT_EQ(running(), (2u << i68) - 1u) << letter << " I68=" << i68;
      platform::servo_ticks(1200);  // 410 ms are 927
      EXPECT_EQ(running(), 0u);
      for (unsigned cs = 0; cs < kSystems; ++cs) EXPECT_EQ(x(cs), cs > i68 ? 0.0 : letter == 'R' ? 4.0 : 1.0) << cs;
    }
}

TEST_F(ControlCharacters, WhatStopsReachesSystemsThatI68HasPutOutOfReach) {
  run_all();
  ASSERT_EQ(host("I68=0"), "");
  give('Q');
  platform::servo_ticks(6000);
  EXPECT_EQ(running(), 0u);
}

TEST_F(ControlCharacters, CReportsAsManySystemsAsI68Says) {
  ASSERT_EQ(host("&2 INC(Y) &16 INC(Z) &1"), "");
  for (unsigned i68 = 0; i68 < kSystems; ++i68) {
    ASSERT_EQ(host("I68=" + std::to_string(i68)), "");
    const auto words = words_of('C');
    ASSERT_EQ(words.size(), i68 + 1) << "I68=" << i68;
    for (unsigned cs = 0; cs <= i68; ++cs)  // firmware:5.4: incremental Y is bit 20, Z bit 22
      EXPECT_EQ(words[cs], cs == 1 ? "B80020020000000000" : cs == 15 ? "E80020020000000000" : "A80020020000000000");
  }
}

TEST_F(ControlCharacters, BFPVReportTheEightMotorsOfTheGroup) {
  ASSERT_EQ(host("I100,32,100=0 I100=1 I900=1 I2400=1"), "");  // motors 1, 9 and 24
  for (unsigned group = 0; group < 4; ++group) {
    ASSERT_EQ(host("##" + std::to_string(group)), "");
    const auto words = words_of('B');
    ASSERT_EQ(words.size(), 8u);
    for (unsigned i = 0; i < 8; ++i) {
      const unsigned motor = 8 * group + i + 1;
      const bool active = motor == 1 || motor == 9 || motor == 24;
      EXPECT_EQ(words[i], active ? "850000000000" : "050000000000") << "motor " << motor;
    }
    for (const char letter : {'F', 'P', 'V'}) EXPECT_EQ(words_of(letter), std::vector<std::string>(8, "0")) << letter;
  }
  // Motor 24: 5 counts commanded, 3 actual, in 1/(32 * 96) count; low halves in Y (firmware:1.10/8).
  ASSERT_EQ(host("##2 WD$C08,$3C00 WD$C0B,$2400"), "");
  EXPECT_EQ(words_of('P').back(), "3");
  EXPECT_EQ(words_of('F').back(), "2");
}

TEST_F(ControlCharacters, DDisablesAllPlcs) {
  for (unsigned plc = 1; plc < 32; ++plc) ASSERT_EQ(host("OPEN PLC " + std::to_string(plc) + " CLEAR P1=1 CLOSE"), "");
  ASSERT_EQ(host("I5=3 ENABLE PLC 1..31"), "");
  ASSERT_EQ(plc_enabled(), 0xFFFFFFFEu);
  give('D');
  EXPECT_EQ(plc_enabled(), 0u);
}

TEST_F(ControlCharacters, UAndLOpenAndCloseRotaryBuffersOnly) {
  ASSERT_EQ(host("DEF ROT 20"), "");
  give('U');
  EXPECT_EQ(open_buffer_kind(), OPEN_ROTARY);
  give('L');
  EXPECT_EQ(open_buffer_kind(), OPEN_NONE);
  ASSERT_EQ(host("OPEN BIN ROT"), "");
  give('L');
  EXPECT_EQ(open_buffer_kind(), OPEN_NONE);
  ASSERT_EQ(host("OPEN PROG 1"), "");
  give('L');
  EXPECT_EQ(open_buffer_kind(), OPEN_FIXED) << "no other buffer";
}

TEST_F(ControlCharacters, GReportsTheGlobalStatus) {
  EXPECT_EQ(words_of('G'), std::vector<std::string>{"000000000800"});
  ASSERT_EQ(host("DEF ROT 20 OPEN ROT"), "");
  EXPECT_EQ(words_of('G'), std::vector<std::string>{"0000000C0800"}) << "firmware:5.8: bits 19, 18 and 11";
}

// None of the others does anything here: those of a line are line_input's.
TEST_F(ControlCharacters, OthersDoNothing) {
  run_all();
  for (const char letter : {'@', 'H', 'I', 'J', 'M', 'N', 'T', 'W', 'X', 'Y', 'Z', '[', '_'}) {
    platform::sent();
    EXPECT_FALSE(control_character(static_cast<std::uint8_t>(letter - '@'))) << letter;
    EXPECT_EQ(running(), 0xFFFFu) << letter;
    EXPECT_EQ(open_buffer_kind(), OPEN_NONE) << letter;
  }
}

}  // namespace
