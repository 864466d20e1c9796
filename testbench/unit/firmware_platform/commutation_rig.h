// A commutated motor of the native firmware: variables by commands, words of the servo IC by address, phase interrupts
// one by one.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "testbench/unit/firmware_platform/controller.h"

extern "C" {
#include "firmware/hal/hal.h"
#include "firmware/motion/commutation.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/phase_motor.h"
#include "firmware/motion/phase_task.h"
}

namespace brick {

constexpr double kPi = 3.141592653589793, kFull = 8388608;  // a 24-bit word's full scale

inline std::int32_t x_word(std::uint32_t address) { return hal_signed(*hal_x(address)); }
inline std::int32_t y_word(std::uint32_t address) { return hal_signed(*hal_y(address)); }
inline void set_x(std::uint32_t address, std::int64_t value) {
  *hal_x(address) = static_cast<std::uint32_t>(value) & HAL_WORD_MASK;
}
inline void set_y(std::uint32_t address, std::int64_t value) {
  *hal_y(address) = static_cast<std::uint32_t>(value) & HAL_WORD_MASK;
}

class CommutationRig : public ::testing::Test {
 protected:
  static constexpr std::uint32_t kOutput = 0x78002, kAdcA = 0x78005, kAdcB = 0x78006;
  static constexpr std::uint32_t kSource = 0x10F0, kPosition = 0xB4, kCurrents = 0xB9, kIntegrators = 0xBC;

  // Motor 1 follows X:$10F0.
  void SetUp() override { c_.line("I183=$10F0 I101=1 I171=1000"); }

  void set(const std::string& variables) { c_.line(variables); }
  void enable(bool enabled = true) { commutation_enable(0, enabled); }
  // 16-bit units, as Ixx69 has them.
  void command(double output) { commutation_command(0, static_cast<std::int32_t>(output * 256)); }
  void phase(unsigned interrupts = 1) {
    for (unsigned i = 0; i < interrupts; ++i) phase_task_interrupt();
  }
  // The phase position itself, in units of Ixx71.
  void stand_at(std::int32_t position) { set_x(kPosition, position); }

  Controller c_;
};

}  // namespace brick
