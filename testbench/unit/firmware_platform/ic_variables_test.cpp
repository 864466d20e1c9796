// Where each I-variable stands, and those of gate ICs and of what is found with them, on boards of every kind: the
// factory values of each IC alone, addresses of motors through the channels of those that are there, the configuration.
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "testbench/unit/firmware_platform/controller.h"

extern "C" {
#include "firmware/hal/hal.h"
#include "firmware/kernel/tasks.h"
#include "firmware/variables/i_table.h"
#include "firmware/variables/i_variables.h"
#include "firmware/variables/m_variables.h"
#include "firmware/variables/pq_variables.h"
#include "firmware/variables/ssi_inputs.h"
}

namespace brick {
namespace {

constexpr unsigned kIcs = 22, kStarred = 10, kMacro = 18, kNoIc = 22, kNumbers = 8192;

using Place = std::tuple<int, unsigned, unsigned, unsigned>;  // group, number in it, which one of them, channel

// By the digits of the number, firmware:1.3: Ixx, Isx (51 is system 0), I7m00 and I7m50 (IC m*, from 2* on).
Place place_of(unsigned n) {
  if (n < 100) return {I_GROUP_GLOBAL, n, 0, 0};
  if (n < 3300) return {I_GROUP_MOTOR, n % 100, n / 100, 0};
  if (n < 4900) return {I_GROUP_ESA, n % 50, (n - 3300) / 50, 0};
  if (n < 5000) return {I_GROUP_SYSTEM, n - 4900, 0, 0};
  if (n < 5100) return {I_GROUP_GATHER, n - 5000, 0, 0};
  if (n < 6700) return {I_GROUP_CS, n % 100, n / 100 - 51, 0};
  if (n < 6800) return {I_GROUP_GATHER, 99, 0, 0};
  const unsigned of_ic = n % 50;
  if (n < 7000) {
    const unsigned ic = kMacro + (n - 6800) / 50;
    if (of_ic < 10 || of_ic >= 30) return {I_GROUP_MACRO, of_ic, ic, 0};
    return {I_GROUP_SUPPLEMENTARY, of_ic % 10, ic, of_ic / 10 - 1};
  }
  if (n >= 8000) return {I_GROUP_TABLE, n - 8000, 0, 0};
  const unsigned m = n / 100 % 10, starred = n % 100 >= 50 ? 1 : 0;
  const unsigned ic = starred == 0 ? m : m < 2 ? kNoIc : kStarred + m - 2;
  if (of_ic < 10) return {I_GROUP_SERVO, of_ic, ic, 0};
  return {I_GROUP_CHANNEL, of_ic % 10, ic, of_ic / 10 - 1};
}

Place as_tuple(const i_place& p) { return {p.group, p.offset, p.instance, p.channel}; }

unsigned first_of(unsigned ic) {
  if (ic >= kMacro) return 6800 + 50 * (ic - kMacro);
  return ic < kStarred ? 7000 + 100 * ic : 7250 + 100 * (ic - kStarred);
}

// firmware:2.3, firmware:1.11: of one IC that drives the clocks alone, by its number inside the fifty.
double factory(unsigned ic, unsigned of_ic, bool drives) {
  static const std::vector<double> kGlobals = {6527, 0, 3, 2258, 15, 0x7FFFC0, 0xFFFFFE};
  if (of_ic < kGlobals.size()) return kGlobals[of_ic];
  if (of_ic == 7) return drives ? 0 : 3;
  if (of_ic == 40 && ic == kMacro) return 0x4000;
  if (of_ic < 10 || (ic >= kMacro && of_ic >= 30)) return 0;
  if (of_ic % 10 == 0) return 7;
  return of_ic == 11 || of_ic % 10 == 2 ? 1 : 0;
}

TEST(IcVariables, EachNumberStandsInItsPlace) {
  Controller c;
  for (unsigned n = 0; n < kNumbers; ++n) EXPECT_EQ(as_tuple(i_table_place(n)), place_of(n)) << n;
  for (unsigned ic = 0; ic < kIcs; ++ic) {
    i_place place = i_table_place(first_of(ic));
    for (unsigned n = first_of(ic) + 1; n < first_of(ic) + 50; ++n) {
      place = i_table_next_of_ic(place);
      EXPECT_EQ(as_tuple(place), place_of(n)) << n;
    }
  }
}

// firmware:3.8: six numbers of motor 10, and I13, are something else there.
TEST(IcVariables, OnAGeoPmacSevenNumbersStandElsewhere) {
  Controller c(1);
  fake_hal_set_strap(HAL_STRAP_PRODUCT, HAL_PRODUCT_GEO_PMAC);
  c.restart();
  std::map<unsigned, Place> others = {{13, {I_GROUP_ONLY, 0, 0, 0}}, {1020, {I_GROUP_ONLY, 1, 0, 0}}};
  for (unsigned i = 0; i < 5; ++i) others[1015 + i] = {I_GROUP_SSI, i, 0, 0};
  for (unsigned n = 0; n < kNumbers; ++n) {
    const auto other = others.find(n);
    EXPECT_EQ(as_tuple(i_table_place(n)), other != others.end() ? other->second : place_of(n)) << n;
  }
}

// What is not there reads 0 and takes nothing; the start and `=*` have the same values.
TEST(IcVariables, OfOneIcAloneAreTheFactoryValues) {
  for (unsigned ic = 0; ic < kIcs; ++ic) {
    Controller c(1u << ic);
    EXPECT_EQ(i_variable_read(19), first_of(ic) + 7);
    for (unsigned n = 6800; n < 8000; ++n) {
      const bool its_own = n >= first_of(ic) && n < first_of(ic) + 50;
      const double expected = its_own ? factory(ic, n - first_of(ic), true) : 0;
      EXPECT_EQ(i_variable_read(n), expected) << "I" << n << " of IC " << ic;
      EXPECT_EQ(i_variable_default(n), expected) << "I" << n << " of IC " << ic;
      if (its_own) continue;
      i_variable_write(n, 1);
      EXPECT_EQ(i_variable_read(n), 0) << "I" << n << " of IC " << ic;
    }
  }
}

// The first of them drives the clocks; the ring is there without a servo IC only.
TEST(IcVariables, OfAllIcsAreTheFactoryValues) {
  Controller c((1u << kIcs) - 1);
  for (unsigned ic = 0; ic < kIcs; ++ic)
    for (unsigned i = 0; i < 50; ++i)
      EXPECT_EQ(i_variable_read(first_of(ic) + i), i == 40 && ic == kMacro ? 0 : factory(ic, i, ic == 0))
          << "I" << first_of(ic) + i;
}

// Channels are counted through the ICs that are there. Ixx02, 25 and 83 lead to command A, flags and position.
TEST(IcVariables, MotorsAreOnTheChannelsThatAreThere) {
  const std::vector<std::pair<unsigned, std::vector<unsigned>>> boards = {
      {0x3, {0x78000, 0x78100}},
      {1u << 1 | 1u << 12, {0x78100, 0x79220}},
      {1u << 9 | 1u << 10 | 1u << 17 | 3u << 20, {0x7B300, 0x78220, 0x7B320}},
      {0x3FFFF,
       {0x78000, 0x78100, 0x78200, 0x78300, 0x79200, 0x79300, 0x7A200, 0x7A300, 0x7B200, 0x7B300, 0x78220, 0x78320,
        0x79220, 0x79320, 0x7A220, 0x7A320, 0x7B220, 0x7B320}},
      {3u << 20, {}},
      {0, {}},
  };
  for (const auto& [fitted, bases] : boards) {
    Controller c(fitted);
    for (unsigned channel = 0; channel < 192; ++channel) {
      const unsigned at = channel / 4 < bases.size() ? bases[channel / 4] + 8 * (channel % 4) : 0;
      EXPECT_EQ(i_variable_read(8000 + channel), at) << std::hex << fitted << " line " << channel;
      EXPECT_EQ(i_variable_default(8000 + channel), at) << std::hex << fitted << " line " << channel;
      if (channel >= 32) continue;
      const unsigned motor = 100 * (channel + 1);
      EXPECT_EQ(i_variable_read(motor), channel == 0 ? 1 : 0) << motor;
      EXPECT_EQ(i_variable_read(motor + 2), at == 0 ? 0 : at + 2) << motor;
      EXPECT_EQ(i_variable_read(motor + 3), 0x3501 + channel) << motor;
      EXPECT_EQ(i_variable_read(motor + 4), 0x3501 + channel) << motor;
      EXPECT_EQ(i_variable_read(motor + 24), 1) << motor;
      EXPECT_EQ(i_variable_read(motor + 25), at) << motor;
      EXPECT_EQ(i_variable_read(motor + 83), at == 0 ? 0 : at + 1) << motor;
    }
  }
}

// I4900 on is as found at this start, whatever was saved; I20 to I23 are a factory value.
TEST(IcVariables, ConfigurationIsFoundAtEachStart) {
  struct Case {
    unsigned fitted;
    const char *ics, *bases;
  };
  const std::vector<Case> cases = {
      {0x3FF, "$3FF|$3FF|$0|$0", "$0|$0|$0|$0"},
      {0x3FC00, "$FF000|$FF000|$0|$0", "$0|$0|$0|$0"},
      {5u << 18 | 1, "$1|$1|$5|$5", "$78400|$7A400|$0|$0"},
      {0xFu << 18, "$0|$0|$F|$F", "$78400|$79400|$7A400|$7B400"},
  };
  for (const Case& k : cases) {
    Controller fitted(k.fitted);
    EXPECT_EQ(fitted.line("I4900..4903"), k.ics);
    EXPECT_EQ(fitted.line("I20..23"), k.bases);
    Controller c(0x3);
    c.line("SAVE");
    fake_hal_fit(k.fitted);
    c.restart();
    EXPECT_EQ(c.line("I4900..4903"), k.ics) << "a save of two ICs";
    EXPECT_EQ(c.line("I20..23"), "$0|$0|$0|$0");
    EXPECT_EQ(c.line("I4908"), "$10800");
  }
}

// firmware:2.2: vendor 1, revision 1 from bit 18, card number less 600000 from bit 22.
TEST(IcVariables, CardNumberIsReportedLessSixHundredThousand) {
  Controller c;
  for (const auto& [card, field] :
       std::vector<std::pair<unsigned, unsigned>>{{603382, 3382}, {602413, 2413}, {600001, 1}, {600000, 0}, {77, 77}}) {
    fake_hal_set_strap(HAL_STRAP_CARD, card);
    c.restart();
    EXPECT_EQ(i_variable_read(4909), 1.0 + 262144.0 + 4194304.0 * field) << card;
  }
  for (unsigned n = 4910; n < 5000; ++n) EXPECT_EQ(i_variable_read(n), 0) << n;
  for (const unsigned n : {4905u, 4906u, 4907u}) EXPECT_EQ(i_variable_read(n), 0) << n;
}

TEST(IcVariables, DualPortedRamIsReportedWhereItIs) {
  Controller c;
  EXPECT_EQ(c.line("I24 I4904"), "$60000|$1");
  fake_hal_set_strap(HAL_STRAP_DPRAM_WORDS, 0);
  c.restart();
  c.line("I6=1 I3=2");
  EXPECT_EQ(c.line("I24 I4904"), "$0|$0");
}

// servo-ic:2.5: each variable of an IC has its bits, and changes no others.
TEST(IcVariables, EachChangesItsOwnBitsAlone) {
  struct Field {
    unsigned number, lsb, width;
    std::uint32_t address;
    bool y;
  };
  const std::vector<Field> fields = {
      {7000, 8, 15, 0x7801C, false}, {7001, 16, 4, 0x78004, false}, {7002, 20, 4, 0x78004, false},
      {7003, 0, 12, 0x78004, false}, {7004, 0, 8, 0x7801C, false},  {7005, 0, 24, 0x7800C, false},
      {7006, 0, 24, 0x78014, false}, {7020, 0, 4, 0x7800D, false},  {7021, 13, 1, 0x7800D, false},
      {7022, 4, 4, 0x7800D, false},  {7023, 8, 2, 0x7800D, false},  {7024, 15, 1, 0x7800D, false},
      {7025, 16, 2, 0x7800D, false}, {7026, 22, 2, 0x7800D, false}, {7027, 20, 2, 0x7800D, false},
      {7028, 19, 1, 0x7800D, false}, {7029, 18, 1, 0x7800D, false}, {7040, 0, 4, 0x7801D, false},
      {6800, 8, 15, 0x7840D, false}, {6801, 16, 4, 0x7840C, false}, {6802, 20, 4, 0x7840C, false},
      {6803, 0, 12, 0x7840C, false}, {6804, 0, 8, 0x7840D, false},  {6806, 0, 24, 0x7840E, false},
      {6840, 0, 24, 0x7840F, false}, {6841, 0, 24, 0x7840F, true},  {6820, 0, 4, 0x7841D, false},
      {6827, 20, 2, 0x7841D, false}, {6828, 19, 1, 0x7841D, false},
  };
  const auto words = [](std::uint32_t base) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t address = base; address < base + 0x20; ++address) {
      found.push_back(std::uint32_t{*hal_x(address)});
      found.push_back(std::uint32_t{*hal_y(address)});
    }
    return found;
  };
  Controller c(1u << kMacro | 1);
  for (const Field& f : fields) {
    const std::uint32_t base = f.number < 7000 ? 0x78400 : 0x78000, ones = (1u << f.width) - 1;
    for (const std::uint32_t value : {0u, ones, ones & 0x555555u}) {
      auto expected = words(base);
      auto& word = expected[2 * (f.address - base) + (f.y ? 1 : 0)];
      word = (word & ~(ones << f.lsb)) | value << f.lsb;
      i_variable_write(f.number, value);
      EXPECT_EQ(words(base), expected) << "I" << f.number << "=" << value;
    }
  }
}

// What was saved of an IC that is not there any more is not taken.
TEST(IcVariables, OfAnIcThatWasTakenAwayAreZero) {
  Controller c(0x3);
  c.line("I7000=1000 I7100=1001 I7122=2 SAVE");
  fake_hal_fit(0x1);
  c.restart();
  EXPECT_EQ(i_variable_read(7000), 1000);
  for (unsigned n = 7100; n < 7150; ++n) EXPECT_EQ(i_variable_read(n), 0) << n;
}

// firmware:3.8: one value, for all systems.
TEST(IcVariables, OnAGeoPmacI13AndI1020AreThoseOfEachSystem) {
  Controller c(1);
  fake_hal_set_strap(HAL_STRAP_PRODUCT, HAL_PRODUCT_GEO_PMAC);
  c.restart();
  i_variable_write(13, 7);
  i_variable_write(6620, 300);
  EXPECT_EQ(i_variable_read(13), 7);
  EXPECT_EQ(i_variable_read(1020), 300);
  for (unsigned n = 5100; n < 6800; ++n) {
    if (n < 6700 && n % 100 == 13) { EXPECT_EQ(i_variable_read(n), 7) << n; }
    if (n < 6700 && n % 100 == 20) { EXPECT_EQ(i_variable_read(n), 300) << n; }
    if (n >= 6700) { EXPECT_EQ(i_variable_read(n), 0) << n; }
  }
}

TEST(IcVariables, NumbersBehindTheLastReadZeroAndTakeNothing) {
  Controller c;
  i_variable_write(8191, 77);
  for (const unsigned number : {8192u, 8193u, 0xFFFFFFFFu}) {
    i_variable_write(number, 5);
    i_variable_restore_integer(number, 5);
    i_variable_restore_float(number, 5);
    EXPECT_EQ(i_variable_read(number), 0) << number;
  }
  EXPECT_EQ(i_variable_read(8191), 77);
  // Each group of words begins where another ends. That of P0 would define an M-variable of its own value 5.
  c.line("Q0=2 P8191=3 M8191->* M8191=4 WL$6000,$000001000005");
  const std::string before = c.line("RHL$3FFF RHL$6000 RHL$9FFF RHL$A000");
  for (const unsigned number : {8192u, 0xFFFFFFFFu}) {
    m_variable_write(number, 9);
    p_variable_write(number, 9);
    q_variable_write(0, number, 9);
    EXPECT_EQ(m_variable_read(number), 0);
    EXPECT_EQ(p_variable_read(number), 0);
    EXPECT_EQ(q_variable_read(0, number), 0);
  }
  EXPECT_EQ(c.line("Q0 P8191 M8191"), "2|3|4");
  EXPECT_EQ(c.line("RHL$3FFF RHL$6000 RHL$9FFF RHL$A000"), before);
}

// firmware:9.3: Iyy10 to Iyy39 go with Iyy00, its neighbours and those of other motors stay.
TEST(IcVariables, ExtendedServoTakesThirtyVariablesWithIt) {
  Controller c;
  c.line("I3350=1 I3400=1");
  for (unsigned n = 3301; n < 3450; ++n)
    if (n != 3350 && n != 3400) i_variable_write(n, 2.5);
  c.line("I3350=0");
  for (unsigned n = 3351; n < 3400; ++n) EXPECT_EQ(i_variable_read(n), n >= 3360 && n < 3390 ? 0 : 2.5) << n;
  for (unsigned n = 3401; n < 3450; ++n) EXPECT_EQ(i_variable_read(n), 2.5) << n;
  EXPECT_EQ(i_variable_read(3309), 2.5);
  EXPECT_EQ(i_variable_read(3340), 2.5);
}

// Who writes bits of a variable or the locks lets the other tasks on; other bits stay.
TEST(IcVariables, PartsAreWrittenAndNobodyIsHeldOffBehind) {
  Controller c;
  c.line("I8191=$ABCDEF");
  i_variable_write_part(8191, 0xFF00, 0x1200);
  EXPECT_FALSE(fake_hal_masked());
  EXPECT_EQ(i_variable_read(8191), 0xAB12EF);
  c.line("I41=8");
  i_variable_write_part(8191, 0xFF, 0x34);
  EXPECT_FALSE(fake_hal_masked());
  EXPECT_EQ(i_variable_read(8191), 0xAB12EF) << "I41 locks it";
  i_variable_set_locks(0xA5);
  EXPECT_EQ(i_variable_locks(), 0xA5u);
  EXPECT_EQ(i_variable_read(4904), 0xA51) << "bits 4 to 11, the DPRAM beside them";
  i_variable_set_locks(0);
  EXPECT_EQ(i_variable_read(4904), 1);
}

// 24 bits: a timer stops at the lowest, and what is written then runs again. Each of the 32 has a count of its own.
TEST(IcVariables, EachTimerRunsForItselfDownToTheLowest) {
  Controller c;
  for (unsigned cs = 0; cs < 16; ++cs)
    for (unsigned i = 0; i < 2; ++i) {
      i_timer_write(5111 + 100 * cs + i, static_cast<std::int32_t>(1000 * cs + 10 * i));
      c.servo(1);
    }
  for (unsigned cs = 0; cs < 16; ++cs)
    for (unsigned i = 0; i < 2; ++i)
      EXPECT_EQ(i_integer_of(5111 + 100 * cs + i), static_cast<std::int32_t>(1000 * cs + 10 * i - (32 - 2 * cs - i)));
  EXPECT_EQ(i_integer_of(5110), 0);
  EXPECT_EQ(i_integer_of(5113), 0);
  i_timer_write(6611, -8388606);
  c.servo(1);
  EXPECT_EQ(i_variable_read(6611), -8388607);
  c.servo(1);
  EXPECT_EQ(i_variable_read(6611), -8388608);
  c.servo(1);
  EXPECT_EQ(i_variable_read(6611), -8388608);
  i_timers_pass();
  EXPECT_FALSE(fake_hal_masked());
}

// They are not kept (firmware:8.5): 0 at a start, and one less each servo interrupt since, as after power-on.
TEST(IcVariables, TimersBeginAnewWithEachStart) {
  for (const char* reset : {"$$$\r", "$$$***\r"}) {
    Controller c;
    c.servo(1000);
    c.line("I5111=500 I6612=7");
    c.servo(10);
    c.send(reset);
    c.servo(5);
    for (const unsigned number : {5111u, 5112u, 6612u}) EXPECT_EQ(i_variable_read(number), -5) << reset << number;
  }
}

// firmware:3.8, servo-ic:11.4: the second channel is $20 behind the first; without the option there is none.
TEST(IcVariables, SsiInputsStandAtTwoAddresses) {
  Controller c(1);
  for (const int product : {0, int{HAL_PRODUCT_GEO_PMAC}, HAL_PRODUCT_GEO_PMAC | HAL_PRODUCT_FEEDBACK_2}) {
    fake_hal_set_strap(HAL_STRAP_PRODUCT, static_cast<unsigned>(product));
    for (std::uint32_t address = 0xFF00; address < 0x10000; ++address)
      EXPECT_EQ(ssi_inputs_have(address),
                (product & HAL_PRODUCT_FEEDBACK_2) != 0 && (address == 0xFF54 || address == 0xFF74))
          << address;
  }
}

}  // namespace
}  // namespace brick
