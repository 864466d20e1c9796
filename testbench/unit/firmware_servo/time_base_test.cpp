// How the time base of a coordinate system goes to what it is told (motion:5.1, firmware:2.1): X:$2002 is what the next
// servo cycle adds to program time, 2^-23 ms.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "testbench/unit/firmware_platform/controller.h"

extern "C" {
#include "firmware/hal/hal.h"
}

namespace brick {
namespace {

class TimeBase : public ::testing::Test {
 protected:
  static void source(std::int32_t value) { *hal_x(0x10F3) = static_cast<std::uint32_t>(value) & HAL_WORD_MASK; }
  long after(unsigned interrupts) {
    c_.servo(interrupts);
    return std::stol(c_.line("RX$2002"));
  }
  void from_outside() {
    c_.line("I5194=8388607 I5193=$10F3");
    ASSERT_EQ(after(1), 0);
  }

  Controller c_;
};

TEST_F(TimeBase, AnOutsideSourceIsSlewedAtIsx94) {
  from_outside();
  c_.line("I5194=100");
  source(1050);
  EXPECT_EQ(after(1), 100);
  EXPECT_EQ(after(9), 1000);
  EXPECT_EQ(after(1), 1050);
  source(500);
  EXPECT_EQ(after(2), 850);
  c_.line("I5194=8388607");
  EXPECT_EQ(after(1), 500);
}

TEST_F(TimeBase, AnOutsideSourceThatRunsBackwardsStops) {
  from_outside();
  source(700);
  EXPECT_EQ(after(1), 700);
  source(-700);
  EXPECT_EQ(after(1), 0);
}

// H and its end go at Isx95, what comes then at Isx94 again.
TEST_F(TimeBase, HoldsAreSlewedAtIsx95) {
  from_outside();
  source(1000);
  c_.line("I5195=100 OPEN PROG 1 CLEAR LINEAR INC TM100000 X1000 X1000 CLOSE &1B1R");
  EXPECT_EQ(after(3), 1000);
  c_.line("&1H");
  EXPECT_EQ(after(4), 600);
  c_.line("I5194=50");
  EXPECT_EQ(after(1), 500) << "Isx94 is for later";
  c_.line("I5194=8388607");
  EXPECT_EQ(after(20), 0);
  source(800);
  EXPECT_EQ(after(1), 0) << "held, whatever the source says";
  c_.line("&1R");
  EXPECT_EQ(after(3), 300);
  EXPECT_EQ(after(5), 800);
  source(5000);
  EXPECT_EQ(after(1), 5000);
}

TEST_F(TimeBase, ItsOwnIsSlewedAtIsx94) {
  c_.line("I10=4000000 I5194=1000000");
  c_.line("&1%100");
  EXPECT_EQ(after(10), 4000000);
  c_.line("&1%50");
  EXPECT_EQ(after(1), 3000000);
  EXPECT_EQ(after(5), 2000000);
}

// The table comes before the programs: what it makes acts in the same interrupt. Another system's word is as good.
TEST_F(TimeBase, TheTableComesFirst) {
  c_.line("I8000=$4010F4 I8001=1 I8002=0 I5194=8388607 I5193=$3502 I5294=8388607 I5293=$2002");
  c_.servo(2);
  *hal_x(0x10F4) = 5000;
  EXPECT_EQ(after(1), 10000);
  EXPECT_EQ(c_.line("RX$2102"), "10000");
}

// There are sixteen systems: behind the words of the last a source is what lies in memory.
TEST_F(TimeBase, WordsBehindTheLastSystemAreMemory) {
  c_.line("I5194=8388607 I6693=0 I5193=$2F00");
  EXPECT_EQ(after(2), 3713991) << "that of &16";
  for (const std::uint32_t address : {0x3000u, 0x3002u}) {
    *hal_x(address) = 1000 + address;
    c_.line("I5193=" + std::to_string(address));
    EXPECT_EQ(after(1), 1000 + static_cast<long>(address));
  }
}

}  // namespace
}  // namespace brick
