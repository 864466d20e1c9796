#include "firmware/host/dpram_motors.h"

#include <stdint.h>

#include "firmware/base/dpram.h"
#include "firmware/base/memory_map.h"
#include "firmware/hal/hal.h"
#include "firmware/host/dpram_report.h"
#include "firmware/kernel/background.h"
#include "firmware/motion/average_velocity.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/motor_status.h"
#include "firmware/variables/i_variables.h"

enum { MOTORS_AT_ONCE = 2 };

/* Each task has a set of its own, so that it can be left where it stands. */
static struct motor_set {
  struct dpram_report report;
  uint32_t left; /* motors that are still to be written, a bit each */
} foreground = {.report = {.busy = DPRAM_MOTOR_HOST_BUSY, .timer = DPRAM_MOTOR_TIMER}},
  background = {.report = {.busy = DPRAM_MOTOR_HOST_BUSY, .timer = DPRAM_MOTOR_TIMER}};
static volatile bool background_writes; /* the servo task leaves the blocks alone until its set is whole */

void dpram_motors_initialize(void) {
  dpram_report_initialize(&foreground.report);
  dpram_report_initialize(&background.report);
  background_writes = false;
}

struct long_word {
  uint32_t x, y;
};

static struct long_word read_long(uint32_t address) {
  return (struct long_word){*hal_x(address) & HAL_WORD_MASK, *hal_y(address) & HAL_WORD_MASK};
}

static int64_t value(struct long_word word) { return (int64_t)hal_signed(word.x) * 16777216 + (int64_t)word.y; }

static struct long_word split(int64_t position) {
  return (struct long_word){(uint32_t)(position >> 24) & HAL_WORD_MASK, (uint32_t)position & HAL_WORD_MASK};
}

/* Positions of the loop from its words, which stay when a motor is not activated. */
static void write_motor(uint32_t motor) {
  const uint32_t words = MEMORY_MOTOR_WORDS * (motor + 1u), block = DPRAM_MOTOR_BLOCKS + DPRAM_MOTOR_STRIDE * motor;
  const struct motor* m = &motors[motor];
  const uint32_t state = hal_mask_servo();
  const struct long_word commanded = read_long(words + MEMORY_MOTOR_COMMANDED);
  const struct long_word actual = read_long(words + MEMORY_MOTOR_ACTUAL), bias = split(m->bias);
  const struct long_word master = split(m->compensation);
  const uint32_t velocity = average_velocity_word(motor);
  const int32_t output = m->output;
  hal_unmask(state);
  const uint64_t error = (uint64_t)(value(commanded) - value(actual));
  dpram_put_long(block + DPRAM_MOTOR_FOLLOWING_ERROR, (uint32_t)(error >> 24), (uint32_t)error);
  dpram_put_word(block + DPRAM_MOTOR_OUTPUT, (uint32_t)output & HAL_WORD_MASK);
  dpram_put_word(block + DPRAM_MOTOR_SERVO_STATUS, motor_status(motor, 0));
  dpram_put_word(block + DPRAM_MOTOR_STATUS, motor_status(motor, 1));
  dpram_put_long(block + DPRAM_MOTOR_BIAS, bias.x, bias.y);
  dpram_put_word(block + DPRAM_MOTOR_VELOCITY, velocity);
  dpram_put_long(block + DPRAM_MOTOR_MASTER, master.x, master.y);
  dpram_put_long(block + DPRAM_MOTOR_POSITION, actual.x, actual.y);
}

/* Some motors, and with the last of them the end of the set. */
static void write_part(struct motor_set* set) {
  for (uint32_t count = 0; set->left != 0u && count < MOTORS_AT_ONCE; ++count) {
    const uint32_t motor = (uint32_t)__builtin_ctz(set->left);
    set->left &= set->left - 1u;
    write_motor(motor);
  }
  if (set->left == 0u) dpram_report_end(&set->report);
}

static void step(struct motor_set* set, int32_t period) {
  const bool begins = !set->report.writes;
  if (!dpram_report_is_due(&set->report, period)) return;
  if (begins) set->left = dpram_read_item(DPRAM_MOTOR_MASK);
  write_part(set);
}

static int32_t foreground_period(void) {
  return i_integer(I48_DPRAM_FOREGROUND_ENABLE) != 0 ? i_integer(I47_DPRAM_FOREGROUND_PERIOD) : 0;
}

bool dpram_motors_servo(void) {
  const int32_t period = foreground_period();
  if (!background_writes && (period != 0 || foreground.report.is_on)) step(&foreground, period);
  return period != 0 || foreground.report.is_on;
}

/* The servo task's set may have begun until the flag was set. The ready word is that task's then: what the background
 * had ready is forgotten, not taken back. */
void dpram_motors_pass(void) {
  const int32_t period = i_integer(I57_DPRAM_MOTORS_ENABLE) != 0 ? i_integer(I50_DPRAM_BACKGROUND_PERIOD) : 0;
  if (period == 0 && !background.report.is_on) return;
  background_writes = true;
  if (foreground.report.is_on && !background.report.writes) {
    dpram_report_initialize(&background.report);
    background_writes = false;
    return;
  }
  step(&background, period);
  background_writes = background.report.writes;
  if (background.report.writes) background_wake();
}
