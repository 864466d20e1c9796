// `$*` (motion:4.4/1): whose counter is cleared, what becomes of a bias.
#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_platform/fake_hal.h"
#include "testbench/unit/firmware_program/platform.h"

extern "C" {
#include "firmware/motion/motor.h"
#include "rtl/regs/brick_regs.h"
}

namespace {

using platform::host;

constexpr std::uint32_t kControl = 0x78005, kCounterReset = 1u << 10;

class PowerOnPosition : public FirmwareTest {
 protected:
  // Values that the channel's control word has had meanwhile.
  static bool resets(const std::string& line) {
    fake_hal_clear_writes();
    EXPECT_EQ(host(line), "") << line;
    const fake_write* log = nullptr;
    const unsigned count = fake_hal_writes(&log);
    bool any = false;
    for (unsigned i = 0; i < count; ++i)
      any |= log[i].x && log[i].address == kControl && (log[i].value & kCounterReset) != 0;
    EXPECT_EQ(*hal_x(kControl) & kCounterReset, 0u) << "and it counts again";
    return any;
  }
};

TEST_F(PowerOnPosition, ClearsTheCounterOfItsChannel) {
  ASSERT_EQ(host("I100=1 I125=$78000 I124=$120001"), "");
  EXPECT_TRUE(resets("#1$*"));
  ASSERT_EQ(host("I197=1"), "");
  EXPECT_FALSE(resets("#1$*")) << "captures in software";
  ASSERT_EQ(host("I197=2"), "");
  EXPECT_TRUE(resets("#1$*"));
  ASSERT_EQ(host("I197=0 I124=$160001"), "");
  EXPECT_FALSE(resets("#1$*")) << "flags over the ring";
  ASSERT_EQ(host("I124=$120001 I125=$78008"), "");
  EXPECT_FALSE(resets("#1$*")) << "another channel's";
  ASSERT_EQ(host("I125=$78000 I101=1"), "");
  EXPECT_FALSE(resets("#1$*")) << "it counts the phase, too";
}

TEST_F(PowerOnPosition, ClearsTheBias) {
  ASSERT_EQ(host("I100=1"), "");
  motors[0].bias = 12345;
  ASSERT_EQ(host("#1$*"), "");
  EXPECT_EQ(motors[0].bias, 0);
  EXPECT_EQ(host("#1P"), "0");
}

// Who asks before the next servo interrupt is told the new position.
TEST_F(PowerOnPosition, IsShownAtOnce) {
  ASSERT_EQ(host("I8000=0 I103=$10F0 I104=$10F0 I100=1 I110=$10F8 I195=$180000 I126=-160"), "");
  *hal_x(0x10F0) = 77 * 32;
  *hal_y(0x10F8) = 123456;
  platform::servo_ticks(3);
  ASSERT_EQ(host("#1P"), "77");
  ASSERT_EQ(host("#1$*"), "");
  EXPECT_EQ(host("#1P"), "123466");
  platform::servo_ticks(3);
  EXPECT_EQ(host("#1P"), "123466");
  ASSERT_EQ(host("#1HMZ"), "");
  EXPECT_EQ(host("#1P"), "0");
}

// motion:4.4: Ixx80 bit 2 alone keeps a start from reading the sensor.
TEST_F(PowerOnPosition, IsReadAtAStartUnlessIxx80Bit2Says) {
  for (unsigned ixx80 = 0; ixx80 < 8; ++ixx80) {
    ASSERT_EQ(host("I8000=0 I103=$10F0 I104=$10F0 I110=$10F8 I195=$180000 I126=0 I100=1"), "");
    ASSERT_EQ(host("I180=" + std::to_string(ixx80) + " SAVE"), "");
    *hal_y(0x10F8) = 0;
    platform::reset("$$$");
    EXPECT_EQ(motors[0].status.home_complete, (ixx80 & 4) == 0) << ixx80;
  }
}

// motion:4.4/5: what an encoder has counted before a start is no movement, and a sensor's position is what it says.
TEST_F(PowerOnPosition, CountsFromTheStartOn) {
  constexpr std::uint32_t kCounter = 0x78000 + SERVO_CHANNEL_X_SERVO_POSITION;  // twice the count
  for (const int active : {0, 1}) {
    ASSERT_EQ(host("I8000=$C78000 I8001=0 I103=$3501 I104=$3501 I110=$10F8 I195=$180000 I180=4"), "");
    ASSERT_EQ(host("I100=" + std::to_string(active) + " SAVE"), "");
    *hal_x(kCounter) = 2 * 1000;
    platform::reset("$$$");
    *hal_y(0x10F8) = 5555;
    ASSERT_EQ(host("I100=1"), "");
    platform::servo_ticks(3);
    EXPECT_EQ(host("#1P"), "0") << active;
    *hal_x(kCounter) = 2 * 1003;
    platform::servo_ticks(3);
    EXPECT_EQ(host("#1P"), "3") << active;
  }
}

}  // namespace
