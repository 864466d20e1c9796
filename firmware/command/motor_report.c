/* From the registers of motors (base/memory_map.h, firmware:1.10). Status words: motion/motor_status.h. */
#include "firmware/command/motor_report.h"

#include "firmware/base/memory_map.h"
#include "firmware/command/reply.h"
#include "firmware/hal/hal.h"
#include "firmware/motion/average_velocity.h"
#include "firmware/motion/motor_status.h"
#include "firmware/variables/i_variables.h"
#include "firmware/variables/words.h"

enum { FOLLOWING_OFFSET = 2 }; /* Ixx06 */

static uint32_t base(uint32_t motor) { return MEMORY_MOTOR_WORDS * (motor + 1u); }
static int32_t variable(uint32_t motor, enum i_name ixxnn) { return i_integer(i_motor(motor + 1u, ixxnn)); }

static int64_t long_word(uint32_t address) {
  uint32_t x = 0, y = 0;
  word_read_long(address, &x, &y);
  return (int64_t)hal_signed(x) * 16777216 + (int64_t)y;
}

/* Text of `value` / (32 * scale), in steps of 1/32 count. */
static void report_scaled(int64_t value, int64_t scale) {
  if (value == 0 || scale == 0) {
    reply_integer(0);
    return;
  }
  const double steps = (double)value / (double)scale;
  reply_number((double)(int64_t)(steps < 0.0 ? steps - 0.5 : steps + 0.5) / 32.0);
}

void motor_report_status(uint32_t motor) {
  reply_hex(motor_status(motor, 0), 6);
  reply_hex(motor_status(motor, 1), 6);
}

/* In offset mode the position that commands count from goes with the master, and so does what is reported. */
void motor_report_position(uint32_t motor) {
  const uint32_t at = base(motor);
  int64_t position = long_word(at + MEMORY_MOTOR_ACTUAL) - long_word(at + MEMORY_MOTOR_COMPENSATION) +
                     long_word(at + MEMORY_MOTOR_BIAS);
  if (((uint32_t)variable(motor, IXX06_FOLLOWING_MODE) & FOLLOWING_OFFSET) != 0u)
    position -= long_word(at + MEMORY_MOTOR_MASTER);
  report_scaled(position, variable(motor, IXX08_POSITION_SCALE));
}

void motor_report_velocity(uint32_t motor) {
  report_scaled(average_velocity(motor), variable(motor, IXX09_VELOCITY_SCALE));
}

void motor_report_following_error(uint32_t motor) {
  const uint32_t at = base(motor);
  report_scaled(long_word(at + MEMORY_MOTOR_COMMANDED) - long_word(at + MEMORY_MOTOR_ACTUAL),
                variable(motor, IXX08_POSITION_SCALE));
}
