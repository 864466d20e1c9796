// What a fault of the firmware itself leaves (firmware/image/fault.h): outputs off, words that tell it to the host, and
// no second restart out of the first.
#include <gtest/gtest.h>

#include "testbench/unit/firmware_platform/controller.h"

extern "C" {
#include "firmware/hal/hal.h"
#include "firmware/image/fault.h"
#include "rtl/regs/brick_regs.h"
}

namespace brick {
namespace {

TEST(FaultRecord, TellsTheLastAndCountsThem) {
  Controller c(0x3);
  EXPECT_EQ(c.line("RHX$70 RHY$70,3"), "0|0 0 0") << "none since power-on";
  for (unsigned count = 1; count <= 2; ++count) {
    const std::uint32_t outputs[] = {0x78005, 0x7810D};  // control words of motors 1 and 6
    c.line("WX$78005,$4000 WX$7810D,$4000 WY$78002,1000 WY$7810C,1000");
    *hal_x(BOARD_LATCHES_X_CONTROL_OUTPUTS) = 0x55;
    ASSERT_TRUE(fault_take(0x80000005u + count, 0x20012345, 0x50FEDCBAu));
    for (const std::uint32_t word : outputs) EXPECT_EQ(*hal_x(word) & SERVO_CHANNEL_CONTROL_AENA_MASK, 0u);
    EXPECT_EQ(*hal_y(0x78002), 0u);
    EXPECT_EQ(*hal_y(0x7810C), 0u);
    EXPECT_EQ(*hal_x(BOARD_LATCHES_X_CONTROL_OUTPUTS), 0u);
    EXPECT_FALSE(fault_take(2, 3, 4)) << "the start that follows fails itself: the watchdog has it";
    c.restart();
    c.line("I6=1 I3=2");
    EXPECT_EQ(c.line("RHX$70,3"), (count == 1 ? "800006" : "800007") + std::string(" 20 50")) << "bit 31 in bit 23";
    EXPECT_EQ(c.line("RHY$70,3"), std::to_string(count) + " 12345 FEDCBA");
    fault_start_done();
  }
}

}  // namespace
}  // namespace brick
