#include "firmware/motion/desired_position.h"

#include <stdbool.h>

#include "firmware/base/mathematics.h"
#include "firmware/base/memory_map.h"
#include "firmware/hal/hal.h"
#include "firmware/motion/average_velocity.h"
#include "firmware/motion/compensation.h"
#include "firmware/motion/desired_path.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/position_loop.h"
#include "firmware/variables/i_variables.h"
#include "firmware/variables/words.h"

enum { FOLLOWS = 1, OFFSET_MODE = 2, PART_OF_COUNT = 16, ERROR_SATURATES = 1 << 13 /* Ixx24 */ };

uint32_t desired_position_extras;
static volatile uint32_t backlash_due; /* bit n: that of motor n may move. B sets all, S clears */

static int32_t variable(uint32_t motor, enum i_name ixxnn) { return i_integer(i_motor(motor, ixxnn)); }

static int64_t position_of(uint32_t motor, int32_t sixteenths) {
  return (int64_t)sixteenths * (POSITION_SUBCOUNT / PART_OF_COUNT) * motors[motor - 1u].position_scale;
}

static uint32_t share_of(double gain) {
  if (!(gain > 0.0)) return 0;
  const int64_t share = math_to_integer(math_scale(1.0 - gain, 32));
  return share < 1 ? 1u : (uint32_t)share;
}

void desired_position_initialize(void) {
  __builtin_memset(desired_paths, 0, sizeof desired_paths);
  backlash_due = 0;
}

void desired_position_pass(void) { backlash_due = UINT32_MAX; }

void desired_position_motor_changed(uint32_t motor) {
  static const volatile uint32_t zero;
  struct desired_path* p = &desired_paths[motor - 1u];
  const uint32_t address = (uint32_t)variable(motor, IXX05_MASTER_ADDRESS);
  const uint32_t share = share_of(i_variable_read(I_MOTOR_BLOCK * motor + (uint32_t)IXX40_DESIRED_POSITION_FILTER));
  const uint32_t mode = (uint32_t)variable(motor, IXX06_FOLLOWING_MODE);
  const bool follows = (mode & FOLLOWS) != 0u;
  const uint32_t state = hal_mask_servo();
  const volatile uint32_t* master = word_exists(true, address) ? hal_x(address) : &zero;
  if (master != p->master || (follows && !p->follows)) p->master_reading = *master; /* no movement until now */
  p->master = master;
  p->follows = follows;
  motors[motor - 1u].origin_follows = (mode & OFFSET_MODE) != 0u;
  p->master_scale = variable(motor, IXX07_MASTER_SCALE);
  p->share = share;
  p->backlash = position_of(motor, variable(motor, IXX86_BACKLASH_SIZE));
  p->backlash_rate = position_of(motor, variable(motor, IXX85_BACKLASH_RATE));
  p->backlash_hysteresis = position_of(motor, variable(motor, IXX87_BACKLASH_HYSTERESIS));
  const bool saturates = ((uint32_t)variable(motor, IXX24_FLAG_MODE) & ERROR_SATURATES) != 0u;
  p->error_most = saturates ? position_of(motor, variable(motor, IXX67_POSITION_ERROR_LIMIT)) : 0;
  if (p->error_most == 0) motors[motor - 1u].held_back = 0;
  const uint32_t bit = 1u << (motor - 1u);
  desired_position_extras &= ~bit;
  if (follows || share != 0u || p->backlash_rate != 0 || p->error_most != 0) desired_position_extras |= bit;
  if (p->backlash_rate == 0) motors[motor - 1u].compensation -= p->taken_up;
  if (p->backlash_rate == 0) p->taken_up = 0;
  hal_unmask(state);
}

void desired_position_shift(uint32_t motor, int64_t by, int64_t corrections) {
  struct motor* m = &motors[motor];
  FIXED_IN_REGISTER(m);
  const int64_t corrected = compensation_exchange(motor, corrections);
  int64_t all = by;
  m->compensation += corrected;
  if (m->loop == LOOP_CLOSED) {
    all += corrected;
    m->trajectory += by;
    m->commanded += all;
    m->closed_at += all;
    m->actual += all;
    desired_paths[motor].turning += by;
  } else {
    m->actual += all;
    desired_path_stand(motor);
  }
  average_velocity_shift(motor, all);
}

/* Servo task ------------------------------------------------------------------------------------------------------- */

/* A motor in a limit follows out of it only. */
static void follow(struct motor* m, struct desired_path* p) {
  const uint32_t reading = *p->master;
  const int64_t step = (int64_t)hal_signed(reading - p->master_reading) * p->master_scale;
  p->master_reading = reading;
  if (step > 0 && (m->found.positive_limit || m->found.positive_desired)) return;
  if (step < 0 && (m->found.negative_limit || m->found.negative_desired)) return;
  m->master += step;
}

/* For who looks at memory from outside. */
static void publish_master(uint32_t motor, const struct motor* m) {
  const uint32_t word = MEMORY_MOTOR_WORDS * (motor + 1u) + MEMORY_MOTOR_MASTER;
  const int64_t position = m->master - m->held_back;
  *hal_x(word) = (uint32_t)(position >> 24) & HAL_WORD_MASK;
  *hal_y(word) = (uint32_t)position & HAL_WORD_MASK;
}

/* How far `wanted` is beyond the error that the loop would see in this interrupt. */
static int64_t held_back(uint32_t motor, const struct desired_path* p, int64_t wanted) {
  const int64_t error = wanted - position_loop_measured(motor);
  return error - fixed_within_long(error, p->error_most);
}

/* The direction turns when the trajectory has come back by more than Ixx87. */
static int64_t backlash(uint32_t motor, const struct motor* m, struct desired_path* p) {
  const int64_t position = m->trajectory + m->master;
  const int64_t forward = p->down ? p->turning - position : position - p->turning;
  if (forward >= 0) {
    p->turning = position;
  } else if (forward < -p->backlash_hysteresis) {
    p->down = !p->down;
    p->turning = position;
  }
  const uint32_t bit = 1u << motor;
  if ((backlash_due & bit) == 0u) return p->taken_up;
  backlash_due &= ~bit;
  const int64_t wanted = p->down ? -(p->backlash + compensation_backlash(motor)) : 0, left = wanted - p->taken_up;
  if (left > p->backlash_rate)
    p->taken_up += p->backlash_rate;
  else if (left < -p->backlash_rate)
    p->taken_up -= p->backlash_rate;
  else
    p->taken_up = wanted;
  return p->taken_up;
}

/* Part `share` of the way to `wanted`, with what is left over kept: it arrives exactly. */
static int64_t filtered(const struct motor* m, struct desired_path* p, int64_t wanted) {
  const int64_t way = wanted - m->commanded;
  const uint64_t low = (uint64_t)(uint32_t)way * p->share;
  const uint64_t fraction = (uint64_t)p->fraction + (uint32_t)low;
  p->fraction = way == 0 ? 0u : (uint32_t)fraction;
  return m->commanded + (way >> 32) * (int64_t)p->share + (int64_t)(low >> 32) + (int64_t)(fraction >> 32);
}

static int32_t saturated(int64_t value) {
  if (value > INT32_MAX) return INT32_MAX;
  return value < INT32_MIN ? INT32_MIN : (int32_t)value;
}

void desired_position_with_extras(uint32_t motor) {
  struct motor* m = &motors[motor];
  struct desired_path* p = &desired_paths[motor];
  if (p->follows) follow(m, p);
  const bool by_tables = (compensation_of_position >> motor & 1u) != 0u;
  if (by_tables || p->backlash_rate != 0) /* else it is a user's */
    m->compensation = by_tables ? compensation_position(motor) : 0;
  if (p->backlash_rate != 0) m->compensation += backlash(motor, m, p);
  int64_t wanted = m->trajectory + m->master + m->compensation;
  if (p->share != 0u) wanted = filtered(m, p, wanted);
  if (p->error_most != 0) m->held_back = held_back(motor, p, wanted);
  wanted -= m->held_back;
  if (p->follows || p->error_most != 0) publish_master(motor, m);
  m->desired_step = saturated(wanted - m->commanded);
  m->commanded = wanted;
}

bool desired_position_backlash_is_down(uint32_t motor) { return desired_paths[motor].down; }
