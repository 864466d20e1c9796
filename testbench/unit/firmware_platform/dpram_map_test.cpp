// The map of the automatic functions in the dual-ported RAM: addresses as the data sheet lists them, and that a word of
// the host is the word of the firmware.
#include "rtl/regs/dpram_map.h"

#include <gtest/gtest.h>

#include "testbench/unit/firmware_platform/controller.h"
extern "C" {
#include "firmware/base/dpram.h"
}

namespace {

constexpr unsigned address(unsigned offset) { return 0x060000 + offset / 4; }

TEST(DpramMap, PmacAddressesAreThoseOfTheDataSheet) {
  EXPECT_EQ(address(DPRAM_MOTOR_HOST_BUSY), 0x06001AU);
  EXPECT_EQ(address(DPRAM_MOTOR_BLOCKS), 0x06001DU);
  EXPECT_EQ(address(DPRAM_MOTOR_BLOCKS + 31 * DPRAM_MOTOR_STRIDE), 0x06001DU + 12 * 31);
  EXPECT_EQ(address(DPRAM_BACKGROUND_COUNT), 0x06019DU);
  EXPECT_EQ(address(DPRAM_CS_BLOCKS + 15 * DPRAM_CS_STRIDE), 0x0601A7U + 32 * 15);
  EXPECT_EQ(address(DPRAM_COMMAND_CONTROL), 0x0603A7U);
  EXPECT_EQ(address(DPRAM_COMMAND_TEXT), 0x0603A8U);
  EXPECT_EQ(address(DPRAM_RESPONSE_CONTROL), 0x0603D0U);
  EXPECT_EQ(address(DPRAM_RESPONSE_TEXT), 0x0603D1U);
  EXPECT_EQ(address(DPRAM_READ_CONTROL), 0x060411U);
  EXPECT_EQ(address(DPRAM_READ_SIZE), 0x060412U);
  EXPECT_EQ(address(DPRAM_WRITE_SIZE), 0x060413U);
  EXPECT_EQ(address(DPRAM_ROTARY_HEADERS), 0x060414U);
  EXPECT_EQ(address(DPRAM_ROTARY_HEADERS + 15 * DPRAM_ROTARY_STRIDE), 0x060441U);
  EXPECT_EQ(address(DPRAM_GATHER_SIZE), 0x06044FU);
  EXPECT_EQ(address(DPRAM_OPEN), 0x060450U);
}

// Nothing overlaps: what follows one area begins at its end.
TEST(DpramMap, AreasFollowEachOther) {
  EXPECT_EQ(DPRAM_MOTOR_BLOCKS + 32 * DPRAM_MOTOR_STRIDE, DPRAM_BACKGROUND_COUNT);
  EXPECT_EQ(DPRAM_CS_BLOCKS + 16 * DPRAM_CS_STRIDE, DPRAM_COMMAND_CONTROL);
  EXPECT_EQ(DPRAM_COMMAND_TEXT + DPRAM_COMMAND_BYTES, DPRAM_RESPONSE_CONTROL);
  EXPECT_EQ(DPRAM_RESPONSE_TEXT + DPRAM_RESPONSE_BYTES, DPRAM_READ_CONTROL);
  EXPECT_EQ(DPRAM_ROTARY_HEADERS + 16 * DPRAM_ROTARY_STRIDE, 0x1110);
}

// Y: and X: words of an address are the halves of an item (host-bus:6.1).
TEST(DpramMap, WordsAreThoseOfTheUser) {
  brick::Controller controller;
  EXPECT_EQ(controller.line("M1->Y:$060450,0,16"), "");
  EXPECT_EQ(controller.line("M2->X:$060450,0,16"), "");
  EXPECT_EQ(controller.line("M1=$1234 M2=$8765"), "");
  EXPECT_EQ(dpram_read(DPRAM_OPEN), 0x1234U);
  EXPECT_EQ(dpram_read(DPRAM_OPEN + DPRAM_WORD_BYTES), 0x8765U);
  EXPECT_EQ(dpram_read_item(DPRAM_OPEN), 0x87651234U);
  dpram_write_item(DPRAM_OPEN, 0x00010002U);
  EXPECT_EQ(controller.line("M1 M2"), "2|1");
}

}  // namespace
