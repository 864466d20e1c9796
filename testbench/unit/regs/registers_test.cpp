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

// Words and fields of servo-ic:2 with the I-variables of servo-ic:4, bit by bit.
TEST(Registers, FieldsOfAChannelAreThoseOfTheDataSheet) {
  namespace sc = regs::servo_channel;
  using regs::Field;
  const auto at = [](const regs::Register& r) { return std::string(1, r.space) + std::to_string(r.address); };
  EXPECT_EQ(at(sc::kStatus) + at(sc::kPhasePosition) + at(sc::kServoPosition) + at(sc::kFlagPosition), "X0X1X2X3");
  EXPECT_EQ(at(sc::kControl) + at(sc::kCompareIncrement) + at(sc::kCompareB), "X5X6X7");
  EXPECT_EQ(at(sc::kTimer1) + at(sc::kTimer2) + at(sc::kOutA) + at(sc::kOutB) + at(sc::kOutC), "Y0Y1Y2Y3Y4");
  EXPECT_EQ(at(sc::kAdcA) + at(sc::kAdcB) + at(sc::kCompareA), "Y5Y6Y7");
  struct Row {
    Field field;
    unsigned high, low;
  };
  const Row rows[] = {{sc::status::kHallCapture, 2, 0},
                      {sc::status::kDemuxInvalid, 3, 3},
                      {sc::status::kEncoderLoss, 7, 7},
                      {sc::status::kEncoderError, 8, 8},
                      {sc::status::kEqu, 9, 9},
                      {sc::status::kCapturedGatedIndex, 10, 10},
                      {sc::status::kCaptured, 11, 11},
                      {sc::status::kCha, 12, 12},
                      {sc::status::kChb, 13, 13},
                      {sc::status::kChc, 14, 14},
                      {sc::status::kFault, 15, 15},
                      {sc::status::kHmfl, 16, 16},
                      {sc::status::kPlim, 17, 17},
                      {sc::status::kMlim, 18, 18},
                      {sc::status::kUser, 19, 19},
                      {sc::status::kFlagW, 20, 20},
                      {sc::status::kFlagV, 21, 21},
                      {sc::status::kFlagU, 22, 22},
                      {sc::status::kFlagT, 23, 23},
                      {sc::control::kDecode, 3, 0},
                      {sc::control::kCaptureSource, 5, 4},
                      {sc::control::kIndexInvert, 6, 6},
                      {sc::control::kFlagInvert, 7, 7},
                      {sc::control::kFlagSelect, 9, 8},
                      {sc::control::kCounterReset, 10, 10},
                      {sc::control::kEquWrite, 11, 11},
                      {sc::control::kEquState, 12, 12},
                      {sc::control::kCompareChannel, 13, 13},
                      {sc::control::kAena, 14, 14},
                      {sc::control::kGatedIndex, 15, 15},
                      {sc::control::kGateState, 16, 16},
                      {sc::control::kIndexDemux, 17, 17},
                      {sc::control::kHardware1t, 18, 18},
                      {sc::control::kPfmDirInvert, 19, 19},
                      {sc::control::kAbInvert, 20, 20},
                      {sc::control::kCInvert, 21, 21},
                      {sc::control::kAbDac, 22, 22},
                      {sc::control::kCPfm, 23, 23},
                      {sc::timer1::kT1, 22, 0},
                      {sc::timer1::kReversed, 23, 23},
                      {sc::timer2::kT2, 22, 0},
                      {sc::servo_position::kDown, 0, 0},
                      {sc::servo_position::kPosition, 23, 1},
                      {sc::adc_a::kValue, 23, 6},
                      {sc::adc_b::kValue, 23, 6},
                      {regs::servo_channel_fine::timer1::kCaptured, 23, 12},
                      {regs::servo_channel_fine::timer1::kCompareB, 11, 0},
                      {regs::servo_channel_fine::timer2::kServo, 23, 12},
                      {regs::servo_channel_fine::timer2::kCompareA, 11, 0}};
  for (const Row& row : rows) {
    EXPECT_EQ(row.field.lsb, row.low) << row.field.name;
    EXPECT_EQ(row.field.lsb + row.field.width - 1, row.high) << row.field.name;
  }
}

TEST(Registers, CodesAreThoseOfTheDataSheet) {
  EXPECT_EQ(regs::decode::kPulseCw, 0u);  // servo-ic:4.1
  EXPECT_EQ(regs::decode::kX1Cw, 1u);
  EXPECT_EQ(regs::decode::kX2Cw, 2u);
  EXPECT_EQ(regs::decode::kX4Cw, 3u);
  EXPECT_EQ(regs::decode::kPulseCcw, 4u);
  EXPECT_EQ(regs::decode::kX1Ccw, 5u);
  EXPECT_EQ(regs::decode::kX2Ccw, 6u);
  EXPECT_EQ(regs::decode::kX4Ccw, 7u);
  EXPECT_EQ(regs::decode::kInternalPulse, 8u);
  EXPECT_EQ(regs::decode::kHallCw, 11u);
  EXPECT_EQ(regs::decode::kMldt, 12u);
  EXPECT_EQ(regs::decode::kHallCcw, 15u);
  EXPECT_EQ(regs::capture_source::kSoftware, 0u);  // servo-ic:2.5
  EXPECT_EQ(regs::capture_source::kIndex, 1u);
  EXPECT_EQ(regs::capture_source::kFlag, 2u);
  EXPECT_EQ(regs::capture_source::kIndexAndFlag, 3u);
  EXPECT_EQ(regs::flag_select::kHmfl, 0u);  // servo-ic:4.2
  EXPECT_EQ(regs::flag_select::kPlim, 1u);
  EXPECT_EQ(regs::flag_select::kMlim, 2u);
  EXPECT_EQ(regs::flag_select::kUser, 3u);
  EXPECT_EQ(regs::clock_direction::kOutput, 0u);  // servo-ic:2.6
  EXPECT_EQ(regs::clock_direction::kInput, 1u);
  EXPECT_EQ(regs::clock_source::kServoIc9s, 17u);  // as the fitted bits
  EXPECT_EQ(regs::clock_source::kMacroIc0, 18u);
  EXPECT_EQ(DECODE_HALL_CCW, 15);
  EXPECT_EQ(CLOCK_SOURCE_NONE, 31);
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
