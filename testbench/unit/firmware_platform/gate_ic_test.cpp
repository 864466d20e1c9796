// Which ICs are found and what of them is written (servo-ic:1, servo-ic:6), word by word on the fake hardware.
#include <gtest/gtest.h>

#include <map>
#include <utility>
#include <vector>

#include "testbench/unit/firmware_platform/fake_hal.h"

extern "C" {
#include "firmware/hal/gate_ic.h"
#include "firmware/hal/hal.h"
}

namespace brick {
namespace {

constexpr std::uint32_t kCyclesPerUs = 79;
constexpr std::uint32_t kPhaseOut = 0x1000, kServoOut = 0x2000;  // of a clock word: 1 is an input
constexpr std::uint32_t kResetClock = 0x3038D2;

// Place and kind of each IC: the words that its kind has at its clock, PWM and ADC strobe.
struct Ic {
  std::uint32_t base;
  bool macro;
  std::uint32_t clock() const { return base + (macro ? 0x0C : 0x04); }
  std::uint32_t pwm() const { return base + (macro ? 0x0D : 0x1C); }
  std::uint32_t adc_strobe() const { return base + (macro ? 0x0E : 0x14); }
  std::uint32_t control(unsigned channel) const { return base + (macro ? 0x15 : 0x05) + 8 * channel; }
};
const std::vector<Ic> kIcs = {{0x78000, false}, {0x78100, false}, {0x78200, false}, {0x78300, false}, {0x79200, false},
                              {0x79300, false}, {0x7A200, false}, {0x7A300, false}, {0x7B200, false}, {0x7B300, false},
                              {0x78220, false}, {0x78320, false}, {0x79220, false}, {0x79320, false}, {0x7A220, false},
                              {0x7A320, false}, {0x7B220, false}, {0x7B320, false}, {0x78400, true},  {0x79400, true},
                              {0x7A400, true},  {0x7B400, true}};

class GateIc : public ::testing::Test {
 protected:
  static void find(std::uint32_t fitted) {
    fake_hal_power_on(fitted);
    gate_ic_find();
  }
  // The X words of its page, by what they hold.
  static std::map<std::uint32_t, std::uint32_t> words(const Ic& ic) {
    std::map<std::uint32_t, std::uint32_t> found;
    for (std::uint32_t address = ic.base; address < ic.base + 0x20; ++address) found[address] = *hal_x(address);
    return found;
  }
};

TEST_F(GateIc, EachIsFoundAtItsPlaceAndKeepsItsWords) {
  for (unsigned n = 0; n < kIcs.size(); ++n) {
    SCOPED_TRACE(n);
    fake_hal_power_on(1u << n);
    for (std::uint32_t address = kIcs[n].base; address < kIcs[n].base + 0x20; ++address)
      *hal_x(address) = 0x123000 + address;
    const auto before = words(kIcs[n]);
    for (std::uint32_t address = kIcs[n].base + 0x20; kIcs[n].macro && address < kIcs[n].base + 0x40; ++address)
      *hal_x(address) = 0x123456;
    fake_hal_clear_writes();
    gate_ic_find();
    const fake_write* log = nullptr;
    for (unsigned i = fake_hal_writes(&log); i-- > 0;)
      EXPECT_TRUE(log[i].address < kIcs[n].base + 0x20 || log[i].address >= kIcs[n].base + 0x40 ||
                  log[i].address == kIcs[n].base + 0x20 + 0x14)
          << std::hex << log[i].address << ": behind its page only the ADC strobe of the next is tried";
    EXPECT_EQ(gate_ic_found(), 1u << n);
    EXPECT_EQ(gate_ic_configuration(), 1u << n);
    for (unsigned other = 0; other < kIcs.size() + 2; ++other) EXPECT_EQ(gate_ic_present(other), other == n) << other;
    auto expected = before;
    for (unsigned channel = 0; channel < (kIcs[n].macro ? 2 : 4); ++channel) expected[kIcs[n].control(channel)] = 0;
    EXPECT_EQ(words(kIcs[n]), expected) << "the channels alone are changed: all off";
  }
}

TEST_F(GateIc, AWordThatIsStuckIsNoIc) {
  for (const unsigned n : {0u, 19u}) {
    for (const std::uint32_t value : {0x5A3C96u, 0xA5C368u, 0u, 0xFFFFFFu}) {
      fake_hal_power_on(1u << n);
      fake_hal_stick(kIcs[n].adc_strobe(), value);
      gate_ic_find();
      EXPECT_EQ(gate_ic_found(), 0u) << n << " at " << value;
    }
  }
}

// One without supplementary channels is a MACROGATE: it has the direction of PHASE alone.
TEST_F(GateIc, AMacrogateIsOneWithoutSupplementaryChannels) {
  for (unsigned n = 18; n < 22; ++n) {
    SCOPED_TRACE(n);
    find(1u << n | 1u);
    EXPECT_FALSE(gate_ic_is_macrogate(n));
    EXPECT_EQ(gate_ic_direction_inputs(n), 3u);
    fake_hal_stick(kIcs[n].control(0), 0);
    gate_ic_find();
    EXPECT_TRUE(gate_ic_is_macrogate(n));
    EXPECT_EQ(gate_ic_macrogates(), 1u << n);
    EXPECT_EQ(gate_ic_configuration(), (1u << n | 1u) | 1u << (24 + n - 18));
    EXPECT_EQ(gate_ic_direction_inputs(n), 1u);
    EXPECT_EQ(gate_ic_direction_inputs(0), 3u);
    *hal_x(kIcs[n].control(1)) = 0x123;
    gate_ic_find();
    EXPECT_EQ(*hal_x(kIcs[n].control(1)), 0x123u) << "what it has not is not written";
    *hal_x(kIcs[n].clock()) = 0;
    gate_ic_release_clocks();
    EXPECT_EQ(*hal_x(kIcs[n].clock()), kPhaseOut);
  }
}

TEST_F(GateIc, DirectionsHaveTheirVariables) {
  const std::pair<std::uint32_t, unsigned> variables[] = {{7007, 0},  {7907, 9},  {7257, 10}, {7957, 17},
                                                          {6807, 18}, {6957, 21}, {7006, 22}, {0, 22}};
  for (const auto& [variable, ic] : variables) EXPECT_EQ(gate_ic_of_direction(variable), ic) << variable;
}

// Each word of each kind at its address, in full; none of an IC that is not there.
TEST_F(GateIc, WordsAreWrittenWhereTheyAre) {
  find(1u << 1 | 1u << 18);
  gate_ic_set_word(1, GATE_WORD_DAC_STROBE, 0x1ABCDE1);
  gate_ic_set_word(1, GATE_WORD_ADC_STROBE, 0xABCDE2);
  gate_ic_set_word(18, GATE_WORD_ADC_STROBE, 0xABCDE3);
  gate_ic_set_word(18, GATE_WORD_RING_CONTROL, 0xABCDE4);
  gate_ic_set_word(18, GATE_WORD_NODE_ACTIVATION, 0x1ABCDE5);
  EXPECT_EQ(*hal_x(0x7810C), 0xABCDE1u);
  EXPECT_EQ(*hal_x(0x78114), 0xABCDE2u);
  EXPECT_EQ(*hal_x(0x7840E), 0xABCDE3u);
  EXPECT_EQ(*hal_x(0x7840F), 0xABCDE4u);
  EXPECT_EQ(*hal_y(0x7840F), 0xABCDE5u);
  fake_hal_fit(~0u);
  gate_ic_set_word(2, GATE_WORD_DAC_STROBE, 0x123456);
  EXPECT_EQ(*hal_x(0x7820C), 0u) << "not found at the start";
}

// A field changes its bits alone; what others switch in a channel's word stays, EQU write does not.
TEST_F(GateIc, FieldsChangeTheirBitsAlone) {
  find(1u << 1 | 1u << 18);
  gate_ic_set_channel_field(1, 2, 4, 3, 0xD);
  EXPECT_EQ(*hal_x(kIcs[1].control(2)), 0x50u) << "three bits from 4";
  *hal_x(kIcs[1].control(2)) |=
      0x4000 | 0x400 | 0x1000 | 0x800 | 0x200000;  // AENA, counter, EQU and its write; another's
  gate_ic_set_channel_field(1, 2, 0, 4, 7);
  EXPECT_EQ(*hal_x(kIcs[1].control(2)), 0x5457u);
  EXPECT_EQ(*hal_x(kIcs[1].control(1)), 0u);
  gate_ic_set_field(18, GATE_WORD_PWM, 8, 15, 6000);
  EXPECT_EQ(*hal_x(kIcs[18].pwm()), 6000u << 8 | 0xFu) << "of the reset value the rest";
  gate_ic_set_field(18, GATE_WORD_CLOCK, 16, 4, 2);
  EXPECT_EQ(*hal_x(kIcs[18].clock()), (kResetClock & ~0xF0000u) | 2u << 16);
  fake_hal_fit(~0u);
  gate_ic_set_field(2, GATE_WORD_CLOCK, 16, 4, 2);
  EXPECT_EQ(*hal_x(kIcs[2].clock()), 0u) << "not found at the start";
}

TEST_F(GateIc, CounterAndCompareOutputOfOneChannel) {
  find(1u << 1);
  const std::uint32_t control = kIcs[1].control(3);
  *hal_x(control) = 0x5207;
  gate_ic_set_compare_output(1, 3, false);
  EXPECT_EQ(*hal_x(control), 0x4A07u) << "EQU write, state 0";
  gate_ic_set_compare_output(1, 3, true);
  EXPECT_EQ(*hal_x(control), 0x5A07u);
  fake_hal_clear_writes();
  gate_ic_zero_counter(1, 3);
  const fake_write* log = nullptr;
  ASSERT_EQ(fake_hal_writes(&log), 2u);
  EXPECT_EQ(log[0].value, 0x5607u) << "reset; EQU is not written again";
  EXPECT_EQ(log[1].value, 0x5207u);
  EXPECT_EQ(log[1].address, control);
  *hal_x(control) = 0;
  gate_ic_set_compare_output(1, 3, true);
  EXPECT_EQ(*hal_x(control), 0x1800u) << "no other bit is set";
  fake_hal_fit(~0u);
  *hal_x(kIcs[2].control(0)) = 0x5200;
  fake_hal_clear_writes();
  gate_ic_set_compare_output(2, 0, false);
  gate_ic_zero_counter(2, 0);
  EXPECT_EQ(fake_hal_writes(&log), 0u) << "not found at the start";
}

// A clock that is let go is driven for one and a half phase periods at most: 1.5 * (2 * 6527 + 3) * 3 / 117.9648 us.
TEST_F(GateIc, ReleasedClocksAreAwaited) {
  find(1u << 1 | 1u << 19);
  fake_hal_set_look(0);
  *hal_x(kIcs[1].clock()) = 0x0238D2 & ~(kPhaseOut | kServoOut);  // phase divider 2
  *hal_x(kIcs[1].pwm()) = 0x197F0F;
  *hal_x(kIcs[19].clock()) = kResetClock;
  gate_ic_release_clocks();
  EXPECT_EQ(*hal_x(kIcs[1].clock()), 0x0238D2u | kPhaseOut | kServoOut);
  EXPECT_EQ(*hal_x(kIcs[19].clock()), kResetClock);
  const auto waited_us = [] {
    const std::uint32_t begin = hal_cycles();
    gate_ic_await_release();
    return (hal_cycles() - begin) / kCyclesPerUs;
  };
  const std::uint32_t us = 1.5 * 13057 * 3 / 117.9648, most = 1.5 * 13057 * 3 / 117 + 1;  // whole us, 117 ticks each
  const std::uint32_t waited = waited_us();
  EXPECT_GE(waited, us);
  EXPECT_LE(waited, most);
  EXPECT_EQ(waited_us(), 0u) << "once";
  gate_ic_release_clocks();
  EXPECT_EQ(waited_us(), 0u) << "nothing was driven";
  *hal_x(kIcs[1].clock()) = 0x0F38D2 & ~kPhaseOut;  // the shortest period, divided by 16
  *hal_x(kIcs[1].pwm()) = 0x00000F;
  gate_ic_release_clocks();
  EXPECT_EQ(waited_us(), 1u) << "1.5 * 3 * 16 / 117.9648 us, made whole";
}

// Those that are not there are not written, whatever their words read.
TEST_F(GateIc, ClocksOfTheOnesThatAreThereAreReleased) {
  find(1u << 1);
  fake_hal_fit(~0u);
  *hal_x(kIcs[2].clock()) = 0;
  *hal_x(kIcs[1].clock()) = 0;
  gate_ic_release_clocks();
  EXPECT_EQ(*hal_x(kIcs[1].clock()), kPhaseOut | kServoOut);
  EXPECT_EQ(*hal_x(kIcs[2].clock()), 0u);
}

// Also where an IC has been missed: amplifiers, compare outputs and commands of every servo IC.
TEST_F(GateIc, OutputsGoOffEverywhere) {
  find(1u << 1 | 1u << 18);
  gate_ic_set_channel_field(1, 0, 0, 4, 7);
  fake_hal_fit(~0u);
  for (const Ic& ic : kIcs)
    for (unsigned channel = 0; channel < (ic.macro ? 2 : 4); ++channel) {
      *hal_x(ic.control(channel)) = 0x7000;
      for (unsigned out = 2; out < 5; ++out) *hal_y(ic.base + 8 * channel + out) = 0x123456;
    }
  gate_ic_outputs_off();
  for (const Ic& ic : kIcs)
    for (unsigned channel = 0; channel < (ic.macro ? 2 : 4); ++channel) {
      SCOPED_TRACE(::testing::Message() << std::hex << ic.base << " channel " << channel);
      const std::uint32_t kept = ic.base == 0x78100 && channel == 0 ? 7 : 0;
      EXPECT_EQ(*hal_x(ic.control(channel)), ic.macro ? 0 : kept | 0x800);
      for (unsigned out = 2; out < 5 && !ic.macro; ++out) EXPECT_EQ(*hal_y(ic.base + 8 * channel + out), 0u);
    }
}

}  // namespace
}  // namespace brick
