// Motors 1, 2 and 5 of a controller natively, on position words and flag words that the test writes; 1 and 2 are X and
// Y of coordinate system 1, 5 is in none.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "testbench/unit/firmware_platform/controller.h"

extern "C" {
#include "firmware/hal/hal.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/motor_state.h"
#include "firmware/motion/protection.h"
}

namespace brick {

inline constexpr std::uint32_t kSource = 0x10F0, kFlags = 0x78000, kControl = 0x78005, kEnable = 1u << 14;
inline constexpr std::uint32_t kFault = 1u << 15, kPositive = 1u << 17, kNegative = 1u << 18;
inline constexpr int kFine = 32 * 96;  // position units of a count

class ProtectionRig : public ::testing::Test {
 protected:
  ProtectionRig() {
    c_.line("I8000=0 I103=$10F0 I104=$10F0 I203=$10F1 I204=$10F1 I503=$10F4 I504=$10F4");
    c_.line("I124,3,100=$800001 I424=$800001 I524=$800001 I100=1 I200=1 I500=1 &1#1->X #2->Y");
    servo();
  }
  void servo(unsigned interrupts = 1) { c_.servo(interrupts); }
  static void counts(unsigned motor, double counts) {
    *hal_x(kSource + motor - 1) = static_cast<std::uint32_t>(std::lround(counts * 32)) & HAL_WORD_MASK;
  }
  static void flags(unsigned motor, std::uint32_t bits) { *hal_x(flag_word(motor)) = bits; }
  static std::uint32_t flag_word(unsigned motor) { return kFlags + 0x100 * ((motor - 1) / 4) + 8 * ((motor - 1) % 4); }
  static bool enabled(unsigned motor) { return (*hal_x(flag_word(motor) + 5) & kEnable) != 0; }
  static motor_loop loop(unsigned motor) { return motors[motor - 1].loop; }
  bool status1(unsigned motor, int bit) { return (word(motor, 0) >> bit & 1) != 0; }
  bool status2(unsigned motor, int bit) { return (word(motor, 6) >> bit & 1) != 0; }
  unsigned long word(unsigned motor, unsigned from) {
    protection_pass();  // as the next real-time interrupt does
    return std::stoul(c_.line("#" + std::to_string(motor) + "?").substr(from, 6), nullptr, 16);
  }
  // Motors are where they are commanded to be, for so many interrupts; a line to the host now and then.
  void follow(unsigned interrupts) {
    for (unsigned n = 0; n < interrupts; ++n) {
      for (const unsigned motor : {1u, 2u, 5u})
        if (loop(motor) == LOOP_CLOSED) counts(motor, at(motor));
      servo();
    }
  }
  void follow_until(const std::function<bool()>& there) {
    for (unsigned n = 0; n < 5000 && !there(); ++n) follow(1);
    ASSERT_TRUE(there());
  }
  static double at(unsigned motor) { return static_cast<double>(motors[motor - 1].commanded) / kFine; }
  // Runs `lines` as PROG 1 of &1, motors closed.
  void run(const std::vector<std::string>& lines) {
    c_.line("&1 OPEN PROG 1 CLEAR");
    for (const std::string& line : lines) ASSERT_EQ(c_.line(line), "") << line;
    ASSERT_EQ(c_.line("CLOSE"), "");
    close_all();
    ASSERT_EQ(c_.line("&1B1R"), "");
  }
  bool runs(unsigned cs = 1) {
    return (std::stoul(c_.line("&" + std::to_string(cs) + "??").substr(0, 6), nullptr, 16) & 1u) != 0;
  }
  void close_all() {
    for (const unsigned motor : {1u, 2u, 5u}) ASSERT_TRUE(motor_close(motor - 1));
    servo();
  }

  Controller c_;
};

}  // namespace brick
