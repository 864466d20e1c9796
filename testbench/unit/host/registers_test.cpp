// The generated headers against the data sheet: addresses, reset values and fields written down here by hand.
#include <gtest/gtest.h>

#include "rtl/regs/brick_regs.h"
#include "rtl/regs/brick_regs.hpp"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

TEST(Registers, GateIcBasesAreThoseOfTheSoftwareReference) {
  const std::uint32_t base[10] = {0x078000, 0x078100, 0x078200, 0x078300, 0x079200,
                                  0x079300, 0x07A200, 0x07A300, 0x07B200, 0x07B300};
  const std::uint32_t c_bases[] = GATE_IC_BASES, c_directions[] = GATE_IC_DIRECTION_VARIABLES;
  ASSERT_EQ(GATE_IC_COUNT, 22u);
  for (unsigned i = 0; i < 22; ++i) {
    const unsigned m = i < 10 ? i : i < 18 ? i - 8 : i - 18;
    const bool star = i >= 10 && i < 18, macro = i >= 18;
    const std::uint32_t expected = macro ? 0x078400 + 0x1000 * m : base[m] + (star ? 0x20 : 0);
    const unsigned direction = macro ? 6807 + 50 * m : 7007 + 100 * m + (star ? 50 : 0);
    EXPECT_EQ(regs::kGateIcs[i].base, expected) << i;
    EXPECT_EQ(regs::kGateIcs[i].direction_variable, direction) << i;
    EXPECT_EQ(regs::kGateIcs[i].macro, macro);
    EXPECT_EQ(regs::kGateIcs[i].name, std::to_string(m) + (star ? "*" : ""));
    EXPECT_EQ(c_bases[i], expected);
    EXPECT_EQ(c_directions[i], direction);
  }
}

TEST(Registers, ClockWordsOfTheDefaultsComeOutOfTheFields) {
  using namespace regs::servo_ic;
  namespace cc = clock_control;
  std::uint32_t word = 0;  // I7m01 = 0, I7m02 = 3, I7m03 = 2258 = 4*512 + 3*64 + 2*8 + 2, I7m07 = 0
  word = cc::kAdcDivider.set(cc::kDacDivider.set(cc::kPfmDivider.set(cc::kSclkDivider.set(word, 2), 2), 3), 4);
  word = cc::kServoDivider.set(word, 3);
  EXPECT_EQ(word, 0x3008D2u);
  word = cc::kServoExternal.set(cc::kPhaseExternal.set(word, 1), 1);
  EXPECT_EQ(kClockControl.reset, word) << "after reset both directions are inputs";
  EXPECT_EQ(pwm_control::kMaxCount.set(pwm_control::kDeadtime.set(0, 15), 6527), 0x197F0Fu);
  EXPECT_EQ(kPwmControl.reset, 0x197F0Fu);
  EXPECT_EQ(regs::macro_ic::kClockControl.reset, kClockControl.reset);
}

TEST(Registers, CAndCppHeadersAgree) {
  EXPECT_EQ(HI08_X_HCR, 0xFFFFC2u);
  EXPECT_EQ(HI08_X_HOTX, 0xFFFFC7u);
  EXPECT_EQ(regs::hi08::kHotx.address, HI08_X_HOTX);
  EXPECT_EQ(CPU_BUS_X_BCR, 0xFFFFFBu);
  EXPECT_EQ(CPU_BUS_X_PCTL, 0xFFFFFDu);
  EXPECT_EQ(CPU_BUS_BCR_BA0W_MASK, 0x1Fu);
  EXPECT_EQ(CPU_BUS_BCR_BA1W_MASK, 0x3E0u);
  EXPECT_EQ(CPU_BUS_BCR_BA2W_MASK, 0x1C00u);
  EXPECT_EQ(CPU_BUS_BCR_BA3W_MASK, 0xE000u);
  EXPECT_EQ(CPU_BUS_BCR_BDFW_MASK, 0x1F0000u);
  EXPECT_EQ(BOARD_LATCHES_X_HOST_SIGNALS, 0x070010u);
  EXPECT_EQ(BOARD_LATCHES_X_WATCHDOG_STROBE, 0x070011u);
  EXPECT_EQ(HOST_IO_BASE, 0x210u);
  EXPECT_EQ(HOST_IO_PIC_EDGE_LEVEL, 0x21Bu);
  EXPECT_EQ(SERVO_IC_X_ADC_STROBE, 0x14u);
  EXPECT_EQ(SERVO_IC_ADC_STROBE_RESET, 0xFFFFFEu);
  EXPECT_EQ(SERVO_CHANNEL_CONTROL_AENA_MASK, 1u << 14);
  EXPECT_EQ(regs::servo_channel::control::kAena.mask(), SERVO_CHANNEL_CONTROL_AENA_MASK);
  EXPECT_EQ(regs::kDpramBase, DPRAM_BASE);
}

}  // namespace
}  // namespace brick
