// Global registers of a servo IC, and their words as firmware makes them.
#pragma once

#include <cstdint>

namespace brick {

// X offsets of the IC-global registers.
constexpr unsigned kClockWord = 0x04, kDacStrobe = 0x0C, kAdcStrobe = 0x14, kPwmWord = 0x1C;

// Words as firmware makes them from I7m00..I7m04 and I7m07 (servo-ic:2.6).
constexpr std::uint32_t clock_word(unsigned phase_div, unsigned servo_div, unsigned direction,
                                   unsigned dividers = 2258) {
  return servo_div << 20 | phase_div << 16 | direction << 12 | dividers;
}
constexpr std::uint32_t pwm_word(unsigned max_count, unsigned deadtime = 15) { return max_count << 8 | deadtime; }

}  // namespace brick
