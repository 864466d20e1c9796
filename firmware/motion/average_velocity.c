/* The way of sixteen samples, I60 + 1 servo interrupts apart, divided by 2^I61: with 15 and 8 that of 256 interrupts as
 * a mean of one. A motor's samples come an interrupt after those of the motor before it, so that none has
 * all of them to take. */
#include "firmware/motion/average_velocity.h"

#include "firmware/hal/hal.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/motor.h"
#include "firmware/variables/i_variables.h"

enum { SAMPLES = 16, LARGEST_SHIFT = 62 };

static struct { int64_t at[SAMPLES], way, origin; /* of `at`, as positions are counted now */ } averages[MOTORS];
static uint32_t next, turn, turns; /* the sample, the first motor of the interrupt, interrupts of the sample */

void average_velocity_initialize(void) {
  __builtin_memset(averages, 0, sizeof averages);
  next = turn = 0;
}

static __attribute__((noinline)) void sample(uint32_t motor) {
  for (; motor < MOTORS && motors_active >> motor != 0u; motor += turns) {
    if ((motors_active >> motor & 1u) == 0u) continue;
    const int64_t actual = motors[motor].actual - averages[motor].origin;
    averages[motor].way = actual - averages[motor].at[next];
    averages[motor].at[next] = actual;
  }
}

/* I60 is looked at between two samples, so that each has all motors. */
void average_velocity_servo(void) {
  const uint32_t first = turn;
  if (first == 0u) {
    turns = (uint32_t)i_integer(I60_FILTER_SAMPLE_SPACING) + 1u;
    next = (next + 1u) % SAMPLES;
  }
  turn = first + 1u < turns ? first + 1u : 0u;
  sample(first);
}

void average_velocity_shift(uint32_t motor, int64_t by) { averages[motor].origin += by; }

void average_velocity_restart(uint32_t motor) {
  for (uint32_t i = 0; i < SAMPLES; ++i) averages[motor].at[i] = motors[motor].actual;
  averages[motor].way = averages[motor].origin = 0;
}

/* Samples of the old distance and of the new one are no way of sixteen, nor is what is left of a round. */
void average_velocity_changed(uint32_t instance) {
  (void)instance;
  turn = 0;
  for (uint32_t motor = 0; motor < MOTORS; ++motor) {
    const uint32_t state = hal_mask_servo();
    average_velocity_restart(motor);
    hal_unmask(state);
  }
}

int64_t average_velocity(uint32_t motor) {
  const uint32_t shift = (uint32_t)i_integer(I61_FILTER_SHIFT);
  const uint32_t state = hal_mask_servo();
  const int64_t way = (motors_active >> motor & 1u) != 0u ? averages[motor].way : 0;
  hal_unmask(state);
  const struct motor* m = &motors[motor];
  const int64_t mean = way >> (shift < LARGEST_SHIFT ? shift : LARGEST_SHIFT);
  return m->velocity_scale == m->position_scale ? mean : mean * m->velocity_scale / m->position_scale;
}

uint32_t average_velocity_word(uint32_t motor) {
  const int64_t velocity = average_velocity(motor), most = HAL_WORD_MASK >> 1;
  return (uint32_t)fixed_within_long(velocity, most) & HAL_WORD_MASK;
}
