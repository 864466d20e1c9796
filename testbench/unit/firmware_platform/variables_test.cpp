// I-, P-, Q- and M-variables: ranges, defaults, reports, ranges of numbers, and the hardware behind the servo IC
// globals.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_platform/controller.h"

extern "C" {
#include "firmware/base/float48.h"
#include "firmware/base/status.h"
#include "firmware/hal/hal.h"
#include "firmware/kernel/clock_watch.h"
#include "firmware/kernel/tasks.h"
#include "firmware/variables/i_variables.h"
}

namespace brick {
namespace {

constexpr unsigned kServoIc0 = 1u << 0, kServoIc1 = 1u << 1, kServoIc2 = 1u << 2, kServoIc3Starred = 1u << 11,
                   kMacroIc0 = 1u << 18, kMacroIc1 = 1u << 19;

std::uint32_t x(std::uint32_t address) { return *hal_x(address) & 0xFFFFFFu; }
std::uint32_t y(std::uint32_t address) { return *hal_y(address) & 0xFFFFFFu; }

TEST(IVariables, GlobalDefaults) {
  BRICK_COVERS("I17-1 I18-1");
  Controller c;
  EXPECT_EQ(c.line("I0..2"), "0|0|1");
  EXPECT_EQ(c.line("I4 I5"), "0|0");
  EXPECT_EQ(c.line("I7..10"), "0|2|2|3713991");
  EXPECT_EQ(c.line("I16..19"), "5|10|10|7007");
  EXPECT_EQ(c.line("I24 I37 I52 I68"), "$60000|$0|7|15");
  EXPECT_EQ(c.line("I90..99"), "$39|$4|$FF|$7F|$A0|$7|$A1|$0|$60|$30");
}

// I10 = 640/9 (2 I7000 + 3)(I7001 + 1)(I7002 + 1): for the defaults 3713991.1, the factory dump shows the integer part.
TEST(IVariables, ServoPeriodAgreesWithTheDefaultDividers) {
  BRICK_COVERS("CLK-4");
  Controller c;
  const int i7000 = i_integer(7000), i7001 = i_integer(7001), i7002 = i_integer(7002);
  EXPECT_EQ(i_integer(10), 640 * (2 * i7000 + 3) * (i7001 + 1) * (i7002 + 1) / 9);
  c.line("I7002=7");
  EXPECT_EQ(i_integer(10), 3713991);  // the firmware does not follow the dividers by itself
}

TEST(IVariables, RotaryPointsTake23Bits) {
  BRICK_COVERS("I17-1 I18-1");
  Controller c;
  EXPECT_EQ(c.line("I17=8388607 I17"), "8388607");
  EXPECT_EQ(c.line("I17=8388608 I17"), "0");  // reduced modulo 2^23
  EXPECT_EQ(c.line("I18=8388607 I18"), "8388607");
  EXPECT_EQ(c.line("I17=* I17"), "10");
}

TEST(IVariables, MotorAndCoordinateSystemDefaults) {
  Controller c;
  EXPECT_EQ(c.line("I100 I200 I102 I202 I125 I525"), "1|0|$78002|$7800A|$78000|$78100");
  EXPECT_EQ(c.line("I111 I116 I117 I119 I130 I163 I169 I192"), "32000|32|0.015625|0.015625|2000|4194304|20480|10");
  EXPECT_EQ(c.line("I5188..5190 I5193 I6693 I5199"), "50|1000|1000|$2000|$2F00|0.9998474121");
  EXPECT_EQ(c.line("I8000 I8004 I8007 I8008"), "$78000|$78100|$78118|$0");
}

TEST(IVariables, SignedOnesWrap) {
  Controller c;
  EXPECT_EQ(c.line("I126=8388607 I126"), "8388607");
  EXPECT_EQ(c.line("I126=8388608 I126"), "-8388608");
  EXPECT_EQ(c.line("I126=-5 I126"), "-5");
  EXPECT_EQ(c.line("I129=-32768 I129"), "-32768");
}

// firmware:1.2/1, firmware:1.2/5: 36 bits of mantissa, sign and leading bit among them. 1 + 2^-34 has 35 significant
// bits, 1 + 2^-35 one more: it is rounded up to the former, 1 + 2^-36 down to 1.
TEST(IVariables, RealsHaveTheBitsOfA48BitFloat) {
  Controller c;
  for (const unsigned number : {113u, 117u, 3301u, 3349u, 5189u, 6699u}) {
    const std::string n = "I" + std::to_string(number);
    EXPECT_EQ(c.line(n + "=1/3 P1=1/3 P2=" + n + "-P1 P2"), "0") << n;
    i_variable_write(number, 1 + std::ldexp(1, -34));
    EXPECT_EQ(i_variable_read(number), 1 + std::ldexp(1, -34)) << n;
    i_variable_write(number, 1 + std::ldexp(1, -35));
    EXPECT_EQ(i_variable_read(number), 1 + std::ldexp(1, -34)) << n;
    i_variable_write(number, 1 + std::ldexp(1, -36));
    EXPECT_EQ(i_variable_read(number), 1) << n;
    i_variable_write(number, -0.015625);
    EXPECT_EQ(i_variable_read(number), -0.015625) << n;
    i_variable_write(number, INFINITY);
    EXPECT_TRUE(std::isfinite(i_variable_read(number))) << n;
  }
  i_variable_restore_float(117, 1 + std::ldexp(1, -36));
  EXPECT_EQ(i_variable_read(117), 1) << "what a store holds";
}

// Whether motor n uses the extended algorithm is a switch, firmware:5.2/20; its polynomials are reals.
TEST(IVariables, TheSwitchOfTheExtendedServoIsOneBit) {
  Controller c;
  EXPECT_EQ(c.line("I3300 #1?"), "0|850000000000");
  EXPECT_EQ(c.line("I3300=3 I3300 #1? I3300=2 I3300 I3301=0.5 I3301 #1?"), "1|950000000000|0|0.5|850000000000");
}

// firmware:9.3, motion:1.1/11. The switch of motor 2 is I3350.
TEST(IVariables, GainsOfTheExtendedServoAreThereWhileItIsOn) {
  Controller c;
  EXPECT_EQ(c.line("I3309..3340=5 I3309 I3310 I3339 I3340"), "5|0|0|5");
  EXPECT_EQ(c.line("I3300=1 I3310 I3339 I3310=6.5 I3339=7 I3310 I3339"), "0|0|6.5|7");
  EXPECT_EQ(c.line("I3360=8 I3360 I3300=0 I3310 P(I3310+1)=9 P1"), "0|0|9");
  EXPECT_EQ(c.line("I3310=4 I3310 I3350=1 I3360=8 I3360 I3389=9 I3389"), "0|8|9");
  EXPECT_EQ(c.line("I3350=0 I3360 I3389 I3350=1 I3360 I3389"), "0|0|0|0");
}

TEST(IVariables, NumbersHaveNoFractionUnlessComputed) {
  Controller c;
  c.line("P1=4 P2=6");
  for (const char* text : {"P1.5", "I19.5", "P1.5=3", "P1..2.5", "M1.5->"}) EXPECT_EQ(c.line(text), "ERR003") << text;
  EXPECT_EQ(c.line("P(P1/2-0.5)"), "4");  // 1.5 is 1
  EXPECT_EQ(c.line("P1..2"), "4|6");
}

TEST(IVariables, RunsAndStepsOfNumbers) {
  Controller c;
  EXPECT_EQ(c.line("I16,4"), "5|10|10|7007");
  EXPECT_EQ(c.line("I5213,15,100=10"), "");
  EXPECT_EQ(c.line("I5113 I5213 I6613"), "0|10|10");
  EXPECT_EQ(c.line("I(P1*100+120)=7 I20"), "$0");
  EXPECT_EQ(c.line("P1=3 I(P1*100+120)=7 I420"), "7");
  EXPECT_EQ(c.line("I420=* I420"), "0");
  EXPECT_EQ(c.line("I8190..8192"), "ERR003");
  EXPECT_EQ(c.line("P8181,3,5=6 P8181 P8186 P8191"), "6|6|6");
  EXPECT_EQ(c.line("P8182,3,5=7"), "ERR003") << "8192";
  for (const char* wrong : {"P5,3,0=1", "P5,0,1=1", "P5,0", "P5,3,0"}) EXPECT_EQ(c.line(wrong), "ERR003") << wrong;
  EXPECT_EQ(c.line("P5"), "0");
}

// firmware:1.4/7: lines and results of the conversion table stand at $3501 on.
TEST(IVariables, TakeAddressesOfTheConversionTable) {
  Controller c;
  EXPECT_EQ(c.line("I103=@I8000 I104 = @ I8191 I203,2=@I(8000+5)"), "");
  EXPECT_EQ(c.line("I103..104 I203..204"), "$3501|$35C0|$3506|$3506");
  for (const char* text : {"I103=@I7999", "I103=@I8192", "I103=@8000", "I103=@P8000", "P1=@I8000", "I103=@"})
    EXPECT_EQ(c.line(text), "ERR003") << text;
  EXPECT_EQ(c.line("I103"), "$3501");
}

TEST(IVariables, ValuesAreReadInHexOrDecimalWhateverI9) {
  BRICK_COVERS("I9-2 I9-3");
  Controller c;
  for (const char* mode : {"I9=0", "I9=1", "I9=2", "I9=3"}) {
    c.line(mode);
    c.line("I125=$C020");
    EXPECT_EQ(i_integer(125), 0xC020) << mode;
    c.line("I125=49185");
    EXPECT_EQ(i_integer(125), 49185) << mode;
  }
  EXPECT_EQ(c.line("I125"), "I125=$C021");
  EXPECT_EQ(c.line("I9=0 I125"), "49185");
  EXPECT_EQ(c.line("I9=1 I125"), "I125=49185");
  EXPECT_EQ(c.line("I9=2 I125"), "$C021");
}

TEST(IVariables, TimersCountServoInterruptsDown) {
  Controller c;
  c.line("I5111=100");
  c.servo(30);
  EXPECT_EQ(c.line("I5111"), "70");
  c.servo(100);
  EXPECT_EQ(c.line("I5111"), "-30");
  EXPECT_EQ(c.line("I6612"), std::to_string(-130));
}

TEST(IVariables, ConfigurationReportIsReadOnly) {
  Controller c(kServoIc0 | kServoIc2 | kServoIc3Starred | kMacroIc1);
  EXPECT_EQ(c.line("I4900"), "$2005");  // IC 0, IC 2, IC 3* = bit 13
  EXPECT_EQ(c.line("I4902 I4908"), "$2|$10800");
  EXPECT_EQ(c.line("I4901 I4903"), "$2005|$2") << "types: all 1, which is DSPGATE2 of a MACRO IC";
  EXPECT_EQ(c.send("I4900=0\r"), "\x06");
  EXPECT_EQ(c.line("I4900"), "$2005");
  EXPECT_EQ(c.line("I20 I21"), "$79400|$0");
}

TEST(IVariables, AbsentIcReadsZeroAndIgnoresWrites) {
  Controller c(kServoIc0);
  EXPECT_EQ(c.line("I7100=1000 I7100 I7107 I7110"), "0|0|0");
  EXPECT_EQ(c.line("I7000 I7010 I7011 I7021"), "6527|7|1|0");
}

// servo-ic:7.1/3, in its order.
TEST(ClockSource, FirstIcInTheDocumentedOrderIsChosen) {
  BRICK_COVERS("I19-3");
  struct Case {
    unsigned fitted;
    const char* source;
  };
  const std::vector<Case> cases = {
      {kServoIc0 | kMacroIc0 | kServoIc1, "7007"},
      {kMacroIc0 | kServoIc1 | kServoIc2, "6807"},
      {kServoIc1 | kServoIc2, "7107"},
      {kServoIc2 | kServoIc3Starred, "7207"},
      {1u << 9 | 1u << 10, "7907"},
      {1u << 10 | kMacroIc1, "7257"},
      {kServoIc3Starred | kMacroIc1, "7357"},
      {1u << 17 | kMacroIc1, "7957"},
      {kMacroIc1 | 1u << 20, "6857"},
      {1u << 20 | 1u << 21, "6907"},
      {1u << 21, "6957"},
  };
  for (const Case& k : cases) {
    Controller c(k.fitted);
    EXPECT_EQ(c.line("I19"), k.source) << std::hex << k.fitted;
    EXPECT_EQ(c.line("I" + std::string(k.source)), "0") << std::hex << k.fitted;
  }
}

TEST(ClockSource, TakesDirectionVariablesOnly) {
  BRICK_COVERS("I19-1");
  Controller c;
  for (const char* number : {"6807", "6857", "6907", "6957", "7007", "7107", "7907", "7257", "7957"})
    EXPECT_EQ(c.line(std::string("I19=") + number + " I19"), number);
  for (const char* none : {"7008", "7006", "7057", "7157", "6808", "7", "0"})  // there is no IC 0* and no 1*
    EXPECT_EQ(c.line(std::string("I19=") + none + " I19"), "7957") << none;
  EXPECT_EQ(c.line("I19=* I19"), "7007");
}

// servo-ic:2.6/4 and the check vectors servo-ic:14/16, servo-ic:14/17.
TEST(ServoIcGlobals, StartUpWritesTheDocumentedWords) {
  BRICK_COVERS("CLK-6 I19-3");
  Controller c(kServoIc0 | kServoIc1 | kMacroIc0);
  EXPECT_EQ(x(0x078004), 0x3008D2u);
  EXPECT_EQ(x(0x078104), 0x3038D2u);
  EXPECT_EQ(x(0x07801C), 0x197F0Fu);
  EXPECT_EQ(x(0x07800C), 0x7FFFC0u);
  EXPECT_EQ(x(0x078014), 0xFFFFFEu);
  EXPECT_EQ(x(0x07840C), 0x3038D2u);
  EXPECT_EQ(c.line("I7007 I7107 I6807"), "0|3|3");
}

TEST(ServoIcGlobals, FieldsGoToTheIcAtOnce) {
  BRICK_COVERS("CLK-6");
  Controller c;
  c.line("I7000=1473 I7001=3 I7002=1 I7003=1746 I7004=30");
  EXPECT_EQ(x(0x078004), (1u << 20) | (3u << 16) | 1746u);
  EXPECT_EQ(x(0x07801C), (1473u << 8) | 30u);
  c.line("I7005=$7FFF00 I7106=$F8CDFE");
  EXPECT_EQ(x(0x07800C), 0x7FFF00u);
  EXPECT_EQ(x(0x078114), 0xF8CDFEu);
  c.line("I7010=3 I7012=2 I7013=3 I7014=1 I7015=2 I7016=3 I7017=1 I7018=1 I7019=1 I7011=0");
  // decode 3, compare bit stays 1 on channel 1 of the report only, capture 2, flag 3, gated index, gate state 2, mode
  // 3, invert 1, PFM, 1/T
  EXPECT_EQ(x(0x078005), 0x3u | (2u << 4) | (3u << 8) | (1u << 13) | (1u << 15) | (2u << 16) | (1u << 18) | (1u << 19) |
                             (1u << 20) | (3u << 22));
}

TEST(MacroIcGlobals, DividersGoToItsClockWord) {
  BRICK_COVERS("CLK-1");
  Controller c(kServoIc0 | kMacroIc0);
  c.line("I6800=8845 I6802=1");
  EXPECT_EQ(x(0x07840C) >> 20, 1u);
  EXPECT_EQ(x(0x07840D) >> 8, 8845u);
  EXPECT_EQ(c.line("I6802=17 I6802"), "1");  // 0 to 15
}

// Supplementary channels 1*, 2*: the fields of servo-ic:2.5 without bits 18..17 and 23..22.
TEST(MacroIcGlobals, SupplementaryChannelsAndRingWordsGoToTheIc) {
  Controller c(kServoIc0 | kMacroIc1);
  EXPECT_EQ(x(0x079415), 0x7u | (1u << 4) | (1u << 13)) << "defaults: x4 decode, capture on index, own compare";
  EXPECT_EQ(x(0x07941D), 0x7u | (1u << 4));
  c.line("I6870=3 I6872=10 I6873=2 I6874=1 I6875=3 I6876=3 I6877=3 I6878=1 I6879=1");
  EXPECT_EQ(x(0x07941D), 3u | (10u << 4) | (2u << 8) | (1u << 15) | (1u << 16) | (3u << 20) | (1u << 19));
  EXPECT_EQ(x(0x079415), 0x7u | (1u << 4) | (1u << 13)) << "the other channel is left alone";
  c.line("I6890=$4030 I6891=$FC003F");
  EXPECT_EQ(x(0x07940F), 0x4030u);
  EXPECT_EQ(y(0x07940F), 0xFC003Fu);
  EXPECT_EQ(c.line("I6820 I6820=5 I6820"), "0|0") << "MACRO IC 0 is absent";
}

// Two ICs must never drive the clocks together: the new input is written before the new output, whatever the order on
// the line.
TEST(ClockDirections, OfOneLineAreAppliedInputsFirst) {
  BRICK_COVERS("I19-2 CLK-2");
  for (const char* text : {"I6807=0 I7007=3", "I7007=3 I6807=0"}) {
    Controller c(kServoIc0 | kServoIc1 | kMacroIc0);
    fake_hal_clear_writes();
    EXPECT_EQ(c.line(text), "");
    const fake_write* log = nullptr;
    const unsigned count = fake_hal_writes(&log);
    std::vector<std::uint32_t> addresses;
    for (unsigned i = 0; i < count; ++i)
      if (log[i].x && log[i].address >= 0x078000) addresses.push_back(log[i].address);
    EXPECT_EQ(addresses, (std::vector<std::uint32_t>{0x078004, 0x07840C})) << text;
    EXPECT_EQ(x(0x078004) >> 12 & 3, 3u);
    EXPECT_EQ(x(0x07840C) >> 12 & 3, 0u);
  }
}

// The old source drives its pins on for up to one and a half of its phase periods, (2 I7m00 + 3)(I7m01 + 1) ticks each,
// whatever the new source's are. A CPU cycle is 12/8 ticks.
TEST(ClockDirections, OutputWaitsUntilTheOldSourceHasLetGo) {
  BRICK_COVERS("I19-2");
  for (const auto& [setup, ticks] :
       {std::pair{"", 13057u}, std::pair{"I7001=3", 4 * 13057u}, std::pair{"I7000=1000", 2003u}}) {
    Controller c(kServoIc0 | kServoIc1 | kMacroIc0);
    c.line(setup);
    c.line("I6800=30000 I6801=5");
    fake_hal_clear_writes();
    c.line("I6807=0 I7007=3");
    const fake_write* log = nullptr;
    const unsigned count = fake_hal_writes(&log);
    std::vector<std::uint32_t> at;
    for (unsigned i = 0; i < count; ++i)
      if (log[i].x && log[i].address >= 0x078000) at.push_back(log[i].cycles);
    ASSERT_EQ(at.size(), 2u);
    EXPECT_GE(at[1] - at[0], ticks * 3 / 2 * 2 / 3) << setup;
    EXPECT_LE(at[1] - at[0], ticks * 3 / 2 * 2 / 3 + ticks / 10 + 300) << setup;
  }
}

TEST(SavedData, SurvivesResetAndReInitialisationDoesNotUseIt) {
  Controller c;
  c.line("I17=33 P100=1.25 Q5=-7 I7002=1 I5189=250.5");
  c.line("M7->Y:$78002,8,16,S");
  EXPECT_EQ(c.send("SAVE\r"), "\x06");
  c.line("I17=44 P100=0 I3=2");
  EXPECT_EQ(c.send("$$$ I17=5 P100=5\r"), "\x06") << "what stands behind a reset is dropped";
  EXPECT_EQ(c.line("I17 P100 Q5 I7002 I5189"), "33|1.25|-7|1|250.5");
  EXPECT_EQ(c.line("M7->"), "Y:$78002,8,16,S");
  EXPECT_EQ(x(0x078004) >> 20, 1u);
  c.line("P100=2.5 M9->*M9=6 #1->1000X+7 $$$*** I17=5 P100=5");
  c.line("I3=2 I6=1");
  EXPECT_EQ(c.line("I17 I7002"), "10|3");
  EXPECT_EQ(c.line("P100 Q5 M7-> M9 #1->"), "2.5|-7|Y:$78002,8,16,S|6|1000X+7") << "not of the defaults, nor as saved";
  c.restart();
  EXPECT_EQ(c.line("I17 P100 M9 #1->"), "33|1.25|0|0");
}

TEST(SavedData, JumperE3StartsWithDefaults) {
  BRICK_COVERS("WDT-2");
  Controller c;
  c.line("I7000=100");
  c.line("SAVE");
  fake_hal_set_strap(HAL_STRAP_E3, 1);
  c.restart();
  EXPECT_EQ(i_integer(7000), 6527);
  fake_hal_set_strap(HAL_STRAP_E3, 0);
  c.restart();
  EXPECT_EQ(i_integer(7000), 100);
}

// Factory wait states of main memory, gate ICs, DPRAM, flash and the default area for the CPU clock, and those of I37
// on top of them. The three bits of flash are full already.
TEST(SavedData, WaitStatesAreThoseOfTheCpuClockPlusI37) {
  const auto bcr = [](unsigned main, unsigned gate, unsigned dpram, unsigned flash, unsigned other) {
    return main | gate << 5 | dpram << 10 | flash << 13 | other << 16;
  };
  Controller c;
  EXPECT_EQ(x(0xFFFFFB), bcr(1, 8, 3, 7, 15));
  c.line("I37=$032403 SAVE");
  EXPECT_EQ(x(0xFFFFFB), bcr(1, 8, 3, 7, 15)) << "not before the next start";
  c.restart();
  EXPECT_EQ(x(0xFFFFFB), bcr(4, 8, 4, 7, 18));
  c.line("I37=0 I52=9 SAVE");
  c.restart();
  EXPECT_EQ(x(0xFFFFFB), bcr(1, 10, 4, 7, 15));
  EXPECT_EQ(x(0xFFFFFD), 9u) << "multiplier of the CPU clock - 1";
  for (const unsigned i52 : {0u, 4u, 5u}) {  // three would give the DPRAM write data too late
    c.line("I52=" + std::to_string(i52) + " SAVE");
    c.restart();
    EXPECT_EQ(x(0xFFFFFB), bcr(1, 8, i52 < 5 ? 4 : 3, 7, 15)) << i52;
  }
}

TEST(SavedData, DamageIsReportedAndDefaultsAreUsed) {
  Controller c;
  c.line("I17=33");
  c.line("SAVE");
  fake_hal_flash()[20] ^= 1u;
  c.restart();
  EXPECT_EQ(i_integer(17), 10);
  EXPECT_NE(status_word() & STATUS_FLASH_ERROR, 0u);
}

TEST(Float48, IsThePublishedFormat) {
  // 1 = 0.5 * 2^1: mantissa $400000 000, exponent 2048.
  EXPECT_EQ(float48_pack(1.0).x, 0x400000u);
  EXPECT_EQ(float48_pack(1.0).y, 0x000800u);
  // -1 = -1 * 2^0.
  EXPECT_EQ(float48_pack(-1.0).x, 0x800000u);
  EXPECT_EQ(float48_pack(-1.0).y, 0x0007FFu);
  EXPECT_EQ(float48_pack(0.0).x | float48_pack(0.0).y, 0u);
  for (const double value : {1.0, -1.0, 0.5, -0.5, 3.25, -1e6, 34359738367.0, -34359738368.0, 1.0 / 1024.0})
    EXPECT_EQ(float48_unpack(float48_pack(value)), value);
  for (const double value : {1.0 / 3.0, -std::acos(-1.0), 1e12, 123456.789})
    EXPECT_NEAR(float48_unpack(float48_pack(value)) / value, 1.0, std::ldexp(1.0, -35));
}

TEST(PVariables, LieInUserMemoryAndPrintTenDigits) {
  Controller c;
  c.line("P1=25.3 P2=1/3 P3=10121217025 P4=-0.1 P5=200000/3");
  EXPECT_EQ(c.line("P1..5"), "25.3|0.3333333333|10121217025|-0.1|66666.66667");
  c.line("P11=0.99999999997 P12=-0.99999999997 P13=9.9999999996 P14=-0.00000000001");  // 1 - 2^-35, 10 - 2^-31
  EXPECT_EQ(c.line("P11..14"), "1|-1|10|0");
  EXPECT_EQ(c.line("RL$6001"), "25.3");
  EXPECT_EQ(c.line("P6=1 RHL$6006"), "400000000800");
}

TEST(QVariables, ShareThePoolByI68) {
  Controller c;
  c.line("&2Q0=7");
  EXPECT_EQ(c.line("&2Q0 &1Q0"), "7|0");
  EXPECT_EQ(c.line("RL$8200"), "7");  // 512 each with 16 coordinate systems
  EXPECT_EQ(c.line("&1Q512 Q512=9"), "0");
  EXPECT_EQ(c.line("&2Q0"), "7") << "no Q512 of &1";
  c.line("I68=1");
  c.line("&2Q4095=9");
  EXPECT_EQ(c.line("RL$9FFF"), "9");
  EXPECT_EQ(c.line("Q4096=1 Q4096"), "0");
  for (const auto& [i68, each] :
       {std::pair{0, 8192}, {2, 2048}, {3, 2048}, {4, 1024}, {7, 1024}, {8, 512}, {14, 512}}) {
    const int cs = std::min(i68, 2), last = each - 1, at = 0x8000 + cs * each + last;
    c.line("I68=" + std::to_string(i68));
    c.line("&" + std::to_string(cs + 1));
    c.line("Q" + std::to_string(last) + "=" + std::to_string(i68 + 20));
    EXPECT_EQ(c.line("RL" + std::to_string(at)), std::to_string(i68 + 20)) << "I68=" << i68;
    if (each < 8192) { EXPECT_EQ(c.line("Q" + std::to_string(each) + "=1 Q" + std::to_string(each)), "0") << i68; }
  }
}

TEST(MVariables, PointAtPartsOfWords) {
  Controller c;
  EXPECT_EQ(c.line("M1->"), "*");
  EXPECT_EQ(c.line("M1->Y:$10F0,8,8 M1->"), "Y:$10F0,8,8");
  c.line("M1=$A5");
  EXPECT_EQ(c.line("RHY$10F0"), "A500");
  c.line("M2->Y:$10F0,15 M3->X:$10F1,0,24,S M3=-2");
  EXPECT_EQ(c.line("M2 M3 M1"), "1|-2|165");
  EXPECT_EQ(c.line("RX$10F1 RHX$10F1"), "-2|FFFFFE");
  EXPECT_EQ(c.line("I9=1 M2->"), "M2->Y:$10F0,15");
  c.line("M4->D:$10F2 M4=-1 M5->L:$10F3 M5=0.25");
  EXPECT_EQ(c.line("M4 M5"), "-1|0.25");
  EXPECT_EQ(c.line("M5 RHD$10F2"), "0.25|FFFFFFFFFFFF");
}

// firmware:1.10/11: $4000 is the definition of M0, $5FFF that of M8191.
TEST(MVariables, DefinitionsLieInUserMemory) {
  Controller c;
  c.line("M0->Y:$10F0,8,8 M1->X:$10F1,4,4 M8190->* M8191->*");
  const std::string first = c.line("RHL$4000"), second = c.line("RHL$4001");
  c.line("WL$5FFE,$" + second + ",$" + first);
  EXPECT_EQ(c.line("M8191-> M8190->"), "Y:$10F0,8,8|X:$10F1,4,4");
}

TEST(MVariables, WordsThatDoNotExistReadZero) {
  Controller c;
  EXPECT_EQ(c.line("M1->X:$050000,0,24 M1=5 M1"), "0");
  EXPECT_EQ(c.line("RX$050000 RHL$04FFFF"), "0|000000000000");
  // X:$FFFF8C: half the CPU cycles of a phase period, 13057 / 117.9648 MHz at 78.6432 MHz.
  EXPECT_EQ(c.line("M2->X:$FFFF8C,0,24 M2"), std::to_string(13057 * 8 / 12 / 2));
  EXPECT_EQ(c.line("WX$60010,$1234,$5678 RHX$60010,2"), "1234 5678");
}

// firmware:1.9: one word to 64, decimal and signed or hexadecimal; no address is outside 24 bits.
TEST(Memory, IsReadAndWrittenInEveryForm) {
  Controller c;
  EXPECT_EQ(c.line("WX$10F0,1,-2,$7FFFFF"), "");
  EXPECT_EQ(c.line("WY:$10F0,$800000,3,P0+4"), "");
  EXPECT_EQ(c.line("RX$10F0,3 RY:$10F0,3"), "1 -2 8388607|-8388608 3 4");
  EXPECT_EQ(c.line("RHX$10F0,3 RHY$10F0,2"), "1 FFFFFE 7FFFFF|800000 3");
  EXPECT_EQ(c.line("RHL$10F0,2 RHD$10F1"), "000001800000 FFFFFE000003|FFFFFE000003");
  EXPECT_EQ(c.line("WD$10F0,-1 RD$10F0 RHD$10F0"), "-1|FFFFFFFFFFFF");
  EXPECT_EQ(c.line("WL$10F0,0.75,-1 RL$10F0,2 RHL$10F0,2"), "0.75 -1|6000000007FF 8000000007FF");
}

// firmware:1.9/3: a hexadecimal constant for L and D is the word itself, so that what RHL shows goes back as it is; in
// an expression, and for X and Y, it is a number.
TEST(Memory, HexadecimalConstantsAreWholeWords) {
  Controller c;
  EXPECT_EQ(c.line("WL:$10F0,$400000000800 RHL$10F0 RL$10F0"), "400000000800|1") << "0.5 x 2^(2048 - 2047)";
  EXPECT_EQ(c.line("WL$10F0,$6000000007FF,-1,$FFFFFFFFFFFF RHL$10F0,3"), "6000000007FF 8000000007FF FFFFFFFFFFFF");
  EXPECT_EQ(c.line("WD:$10F0,$123456789ABC,$0,$800000000000 RHD$10F0,3"), "123456789ABC 000000000000 800000000000");
  EXPECT_EQ(c.line("RX$10F0,3 RHY$10F0"), "1193046 0 -8388608|789ABC");
  EXPECT_EQ(c.line("WD$10F0,$A RD$10F0 WL$10F1,$A RHL$10F1"), "10|00000000000A") << "leading digits are 0";
  EXPECT_EQ(c.line("WD$10F0,$10+1,-$10 RD$10F0,2"), "17 -16");
  EXPECT_EQ(c.line("WL$10F0,$10+1,$FF/2 RL$10F0,2"), "17 127.5");
  EXPECT_EQ(c.line("WD$10F0,17 WL$10F1,16 RD$10F0 RL$10F1"), "17|16") << "decimal ones are values";
  EXPECT_EQ(c.line("WX$10F0,$123456789 RHX$10F0"), "456789") << "modulo 2^24, as any value";
  for (const char* form : {"L", "D"})
    for (const char* constant : {"$0123456789ABC", "$1234567890ABCDEF01", "$", "$G", "$-1"}) {
      ASSERT_EQ(c.line("WD$10F0,5"), "");
      EXPECT_EQ(c.line("W" + std::string(form) + "$10F0," + constant), "ERR003") << constant;
      EXPECT_EQ(c.line("RD$10F0"), "5") << constant;
    }
}

TEST(Memory, AddressesAndCountsAreChecked) {
  Controller c;
  EXPECT_EQ(
      c.line("RX$FFFFFF RHY$FFFFC0,64"), "0|" + [] {
        std::string zeros = "0";
        for (int i = 1; i < 64; ++i) zeros += " 0";
        return zeros;
      }());
  for (const char* form : {"X", "Y", "L", "D"})
    for (const char* rest : {"$1000000", "-1", "$FFFFFF,2", "$FFFFC1,64", "0,0", "0,65", "0,-1", "0,1.5", "1.5", "",
                             ":", "$10F0,-1", "4294967296", "34359738369"})
      for (const char* command : {"R", "RH"}) EXPECT_EQ(c.line(std::string(command) + form + rest), "ERR003") << rest;
  for (const char* form : {"X", "Y", "L", "D"})
    for (const char* rest : {"$1000000,1", "-1,1", "$FFFFFF,1,2", "$10F0", "$10F0,", "1.5,1", "$10F0,1,"})
      EXPECT_EQ(c.line(std::string("W") + form + rest), "ERR003") << rest;
}

TEST(ConfigurationError, IsReportedWhenTheIcSetDiffersFromTheSavedOne) {
  Controller c(kServoIc0);
  c.line("SAVE");
  fake_hal_set_strap(HAL_STRAP_FITTED, kServoIc0 | kServoIc1);
  fake_hal_fit(kServoIc0 | kServoIc1);
  c.restart();
  EXPECT_EQ(status_word(), static_cast<std::uint32_t>(STATUS_CONFIGURATION));
  EXPECT_FALSE(status_motors_may_enable());
}

TEST(PhaseClock, MissingOneIsReportedAndTasksGoOn) {
  BRICK_COVERS("I19-2");
  Controller c;
  c.line("I5111=1000");
  fake_hal_stop_clocks(true);
  for (int i = 0; i < 20000; ++i) (void)hal_cycles();
  EXPECT_EQ(c.line("???"), "000008000800");
  EXPECT_FALSE(status_motors_may_enable());
  fake_hal_stop_clocks(false);
  (void)hal_cycles();
  EXPECT_EQ(c.line("???"), "000000000800");
}

// Half the CPU cycles from one to the next: (2 I7m00 + 3)(I7m01 + 1) periods of 117.9648 MHz, 8 CPU cycles in 12.
TEST(PhaseClock, PeriodIsThatOfBothDividersOfItsSource) {
  Controller c;
  EXPECT_EQ(c.line("RX$FFFF8C"), std::to_string(13057 * 8 / 12 / 2));
  c.line("I7001=3");
  EXPECT_EQ(c.line("RX$FFFF8C"), std::to_string(13057 * 4 * 8 / 12 / 2));
  c.line("I7000=3000 I7101=15");
  EXPECT_EQ(c.line("RX$FFFF8C"), std::to_string(6003 * 4 * 8 / 12 / 2)) << "servo IC 1 drives nothing";
}

// firmware:8.4/5: at the nominal rate from the loss on, whatever time had passed before.
TEST(PhaseClock, TasksWithoutOneAreNoMoreThanItsPeriodsAllow) {
  Controller c;
  const std::uint32_t phase = 13057 * 8 / 12, servo = 4 * phase;
  const auto wait = [](std::uint32_t cycles) {
    for (const std::uint32_t begin = hal_cycles(); hal_cycles() - begin < cycles;) {}
  };
  wait(1000 * servo);
  fake_hal_stop_clocks(true);
  wait(11 * phase);
  clock_watch_poll();
  const std::uint32_t before = tasks_servo_count();
  for (const std::uint32_t begin = hal_cycles(); hal_cycles() - begin < 100 * servo;) clock_watch_poll();
  EXPECT_NEAR(static_cast<double>(tasks_servo_count() - before), 100.0, 1.0);
  fake_hal_stop_clocks(false);
}

}  // namespace
}  // namespace brick
