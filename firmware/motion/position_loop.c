/* In integers, units of motion/fixed_point.h; sums have 7 bits more, so that what Ixx31, 32, 35 and 64 divide by stays.
 * Errors, steps and sums are held to limits beyond what any gain but the smallest can put out, so that no product
 * overflows. */
#include "firmware/motion/position_loop.h"

#include <stdbool.h>
#include <stddef.h>

#include "firmware/base/memory_map.h"
#include "firmware/hal/hal.h"
#include "firmware/motion/compensation.h"
#include "firmware/motion/desired_path.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/notch.h"
#include "firmware/variables/i_variables.h"
#include "firmware/variables/words.h"

enum { FORGETS = 2 };
enum { FINER = 7, INTEGRAL_BITS = 23, GAIN_BITS = 16, DEADBAND_BITS = 4, PART_OF_COUNT = 16 };
enum { INTEGRATES_VELOCITY = 2 };      /* Ixx96 */
#define ERROR_MOST (INT64_C(1) << 39)  /* and integral */
#define SUM_MOST (ERROR_MOST << FINER) /* FINER */
#define PRODUCT_MOST (INT64_C(1) << 62)
#define STEP_MOST (INT64_C(1) << 36) /* and deadband */
#define WORD_MOST 0x7FFFFF

static struct loop {
  /* V, up to `left` */
  const volatile uint32_t *position_source, *velocity_source;
  uint32_t extension; /* Ixx60 */
  int32_t proportional, derivative, velocity_forward, acceleration_forward, integral_gain, deadband_gain;
  int64_t error_most, deadband, integral_most; /* position; the last with its fraction */
  int64_t integrand_most;                      /* FINER: times Ixx33 it is still a number */
  int32_t friction, output_most;               /* output */
  bool only_at_rest, integrates_velocity;
  bool one_source;          /* velocity is that of the position, in the same unit */
  bool simple;              /* no deadband, no notch, position error integrated */
  int32_t small_error_most; /* error_most, if it has no more than 32 bits */
  /* S */
  uint32_t left; /* servo interrupts to the next closure */
  uint32_t position_reading, velocity_reading;
  uint32_t forgets; /* movements that are none */
  int64_t step;     /* how far the commanded position had gone at the last closure */
  int64_t integral; /* position, with INTEGRAL_BITS of fraction */
  bool saturated;
  int64_t filtered; /* PID alone, NOTCH_FINER */
} loops[MOTORS];

static int32_t variable(uint32_t motor, enum i_name ixxnn) { return i_integer(i_motor(motor, ixxnn)); }

/* Variables -------------------------------------------------------------------------------------------------------- */

static const volatile uint32_t* source_of(uint32_t motor, uint32_t ixxnn) {
  static const volatile uint32_t zero;
  const uint32_t address = (uint32_t)i_integer(I_MOTOR_BLOCK * motor + ixxnn);
  return word_exists(true, address) ? hal_x(address) : &zero;
}

/* Position of sixteenths of a count, at most `most`. */
static int64_t position_of(uint32_t motor, int32_t sixteenths, int64_t most) {
  const int64_t magnitude = sixteenths < 0 ? -(int64_t)sixteenths : sixteenths;
  return fixed_smaller(magnitude * (POSITION_SUBCOUNT / PART_OF_COUNT) * variable(motor, IXX08_POSITION_SCALE), most);
}

void position_loop_initialize(void) {
  __builtin_memset(loops, 0, sizeof loops);
  notch_initialize();
}

/* Where a source stands now is no movement. */
static void put(struct loop* l, const struct loop* next) {
  if (l->one_source) l->velocity_reading = l->position_reading;
  l->integral = fixed_within_long(l->integral, next->integral_most);
  if (next->position_source != l->position_source) l->position_reading = *next->position_source;
  if (next->velocity_source != l->velocity_source) l->velocity_reading = *next->velocity_source;
  if (l->left > next->extension) l->left = next->extension;
  __builtin_memcpy(l, next, offsetof(struct loop, left));
}

/* Movement counts from here. */
static void read_words(struct loop* l) {
  l->position_reading = *l->position_source;
  l->velocity_reading = *l->velocity_source;
}

void position_loop_begin(uint32_t motor) {
  struct loop* l = &loops[motor - 1u];
  l->position_source = source_of(motor, IXX03_FEEDBACK_ADDRESS);
  l->velocity_source = source_of(motor, IXX03_FEEDBACK_ADDRESS + 1u);
  read_words(l);
}

void position_loop_motor_changed(uint32_t motor) {
  static struct loop n; /* motion/motor_variables.c makes one after the other */
  notch_motor_changed(motor);
  n.position_source = source_of(motor, IXX03_FEEDBACK_ADDRESS);
  n.velocity_source = source_of(motor, IXX03_FEEDBACK_ADDRESS + 1u);
  n.one_source =
      n.position_source == n.velocity_source && motors[motor - 1u].position_scale == motors[motor - 1u].velocity_scale;
  n.extension = (uint32_t)variable(motor, IXX60_SERVO_CYCLE_EXTENSION);
  n.proportional = variable(motor, IXX30_PROPORTIONAL_GAIN);
  n.derivative = variable(motor, IXX31_DERIVATIVE_GAIN);
  n.velocity_forward = variable(motor, IXX32_VELOCITY_FEEDFORWARD);
  n.integral_gain = variable(motor, IXX33_INTEGRAL_GAIN);
  n.integrand_most = PRODUCT_MOST / (n.integral_gain > 0 ? n.integral_gain : 1);
  n.only_at_rest = variable(motor, IXX34_INTEGRATION_MODE) != 0;
  n.acceleration_forward = variable(motor, IXX35_ACCELERATION_FEEDFORWARD);
  n.integral_most = position_of(motor, variable(motor, IXX63_INTEGRATION_LIMIT), ERROR_MOST) << INTEGRAL_BITS;
  n.deadband_gain = variable(motor, IXX64_DEADBAND_GAIN);
  n.deadband = position_of(motor, variable(motor, IXX65_DEADBAND_SIZE), STEP_MOST);
  n.error_most = position_of(motor, variable(motor, IXX67_POSITION_ERROR_LIMIT), ERROR_MOST);
  n.friction = variable(motor, IXX68_FRICTION_FEEDFORWARD) << OUTPUT_FRACTION_BITS;
  n.output_most = variable(motor, IXX69_OUTPUT_LIMIT) << OUTPUT_FRACTION_BITS;
  n.integrates_velocity = (variable(motor, IXX96_OUTPUT_MODE) & INTEGRATES_VELOCITY) != 0;
  n.small_error_most = n.error_most < INT32_MAX ? (int32_t)n.error_most : INT32_MAX;
  n.simple = n.deadband_gain == 0 && !n.integrates_velocity && !notch_is_used(motor - 1u);
  const uint32_t state = hal_mask_servo();
  put(&loops[motor - 1u], &n);
  hal_unmask(state);
}

void position_loop_restart(uint32_t motor) {
  struct loop* l = &loops[motor];
  motors[motor].closed_at = motors[motor].commanded;
  l->step = l->integral = 0;
  l->saturated = false;
}

/* Servo task ------------------------------------------------------------------------------------------------------- */

/* As nearly every number is. */
static inline bool is_small(int64_t value) { return __builtin_expect(value == (int32_t)value, 1); }

static int32_t saturated(int64_t value) {
  if (value > INT32_MAX) return INT32_MAX;
  return value < INT32_MIN ? INT32_MIN : (int32_t)value;
}

/* Between closures (Ixx60): what the words show now is no movement at the next one. */
static __attribute__((noinline)) void forget_interrupt(struct loop* l) {
  l->forgets--;
  read_words(l);
}

/* The words of the table wrap; positions are the sums of their movement. */
static void measure(struct motor* m, struct loop* l) {
  const uint32_t position = *l->position_source;
  const int64_t moved = (int64_t)hal_signed(position - l->position_reading) * m->position_scale;
  l->position_reading = position;
  int64_t speed = moved;
  if (!l->one_source) {
    const uint32_t velocity = *l->velocity_source;
    speed = (int64_t)hal_signed(velocity - l->velocity_reading) * m->velocity_scale;
    l->velocity_reading = velocity;
  }
  if (__builtin_expect(l->forgets != 0u, 0)) {
    l->forgets--;
    speed = 0;
  } else {
    m->actual += moved;
  }
  m->velocity = is_small(speed) ? (int32_t)speed : saturated(speed);
}

/* FINER. */
static void integrate(struct loop* l, int64_t error, int64_t rest) {
  const int64_t integrand = fixed_within_long(l->integrates_velocity ? rest + error : error, l->integrand_most);
  l->integral = fixed_within_long(l->integral + (l->integral_gain * integrand >> FINER), l->integral_most);
}

static bool integrates(const struct loop* l, bool moves) {
  return l->integral_gain != 0 && !l->saturated && !(moves && l->only_at_rest);
}

/* 2^-7 position units times Ixx30; output, wider than any limit, with NOTCH_FINER more bits. */
static inline int64_t with_gain(const struct loop* l, int64_t sum) {
  if (is_small(sum)) return (int64_t)(int32_t)sum * l->proportional >> (FINER + GAIN_BITS - NOTCH_FINER);
  const int32_t finer = ((int32_t)sum & ((1 << FINER) - 1)) * l->proportional >> FINER;
  return ((fixed_within_long(sum, SUM_MOST) >> FINER) * l->proportional + finer) >> (GAIN_BITS - NOTCH_FINER);
}

/* What a clip leaves of an output, and whether it had to. */
static void put_out(struct motor* m, struct loop* l, int64_t output) {
  const int32_t most = l->output_most, whole = is_small(output) ? (int32_t)output : saturated(output);
  const int32_t clipped = fixed_within(whole, most);
  m->output = clipped;
  l->saturated = clipped == most || clipped == -most;
}

/* Numbers of any size, the deadband, the integral of the velocity's error. */
static int64_t pid(const struct motor* m, struct loop* l, int64_t step) {
  const int64_t limited = fixed_within_long(m->commanded - m->actual, l->error_most);
  int64_t error = limited * (1 << FINER);
  if (l->deadband_gain != 0)
    error += l->deadband_gain * fixed_within_long(limited, l->deadband) * (1 << (FINER - DEADBAND_BITS));
  const int64_t rest = l->velocity_forward * step - (int64_t)l->derivative * m->velocity;
  if (integrates(l, step != 0)) integrate(l, error, rest);
  int64_t sum = error + rest + (l->integral >> (INTEGRAL_BITS - FINER));
  if (l->acceleration_forward != 0) sum += l->acceleration_forward * fixed_within_long(step - l->step, STEP_MOST);
  return with_gain(l, sum);
}

static void close_loop(uint32_t motor, struct motor* m, struct loop* l) {
  const int64_t step = fixed_within_long(m->commanded - m->closed_at, STEP_MOST), finer = pid(m, l, step);
  int64_t output = (notch_is_used(motor) ? notch(motor, finer) : finer) >> NOTCH_FINER;
  if (step > 0) output += l->friction;
  if (step < 0) output -= l->friction;
  if ((compensation_of_torque >> motor & 1u) != 0u) output += compensation_torque(motor, output);
  put_out(m, l, output);
  l->filtered = finer;
  m->closed_at = m->commanded;
  l->step = step;
}

static hal_place words_of(uint32_t motor) { return hal_place_of(MEMORY_MOTOR_WORDS * (motor + 1u)); }

static inline void publish_position(hal_place words, uint32_t which, int64_t position) {
  *hal_x_of(words, which) = (uint32_t)(position >> 24) & HAL_WORD_MASK;
  *hal_y_of(words, which) = (uint32_t)position & HAL_WORD_MASK;
}

static inline void publish_numbers(hal_place words, int32_t velocity, int32_t output) {
  *hal_x_of(words, MEMORY_MOTOR_VELOCITY) = (uint32_t)velocity & HAL_WORD_MASK;
  *hal_x_of(words, MEMORY_MOTOR_FILTER_OUTPUT) = (uint32_t)output & HAL_WORD_MASK;
}

static void publish(uint32_t motor, const struct motor* m) {
  const hal_place words = words_of(motor);
  publish_position(words, MEMORY_MOTOR_COMMANDED, m->commanded);
  publish_position(words, MEMORY_MOTOR_ACTUAL, m->actual);
  publish_numbers(words, m->velocity, m->output);
}

/* The same in half the time, for numbers of 32 bits and what most motors use. What is done with is put away early: so
 * it needs no more registers than a function may spoil. False: nothing has been done. */
static inline bool close_simple_loop(uint32_t motor, struct motor* m, struct loop* l) {
  const int64_t commanded = m->commanded, actual = m->actual;
  const int64_t difference = commanded - actual, long_step = commanded - m->closed_at, change = long_step - l->step;
  if (!l->simple || !is_small(difference) || !is_small(long_step) || !is_small(change) ||
      (compensation_of_torque >> motor & 1u) != 0u)
    return false;
  const hal_place words = words_of(motor);
  publish_position(words, MEMORY_MOTOR_COMMANDED, commanded);
  publish_position(words, MEMORY_MOTOR_ACTUAL, actual);
  m->closed_at = commanded;
  l->step = long_step;
  const int32_t step = (int32_t)long_step, most = l->small_error_most;
  const int32_t error = fixed_within((int32_t)difference, most);
  int64_t sum = (int64_t)error * (1 << FINER) - (int64_t)l->derivative * m->velocity;
  if (step != 0) sum += (int64_t)l->velocity_forward * step;
  if ((int32_t)change != 0) sum += (int64_t)l->acceleration_forward * (int32_t)change;
  if (integrates(l, step != 0))
    l->integral = fixed_within_long(l->integral + (int64_t)l->integral_gain * error, l->integral_most);
  sum += l->integral >> (INTEGRAL_BITS - FINER);
  const int64_t finer = with_gain(l, sum);
  l->filtered = finer;
  int64_t output = finer >> NOTCH_FINER;
  if (step != 0) output += step > 0 ? l->friction : -l->friction;
  put_out(m, l, output);
  publish_numbers(words, m->velocity, m->output);
  return true;
}

void position_loop_show(uint32_t motor) {
  const uint32_t state = hal_mask_servo();
  if ((motors_active >> motor & 1u) != 0u) publish(motor, &motors[motor]);
  hal_unmask(state);
}

/* Of a killed motor commanded and actual position are the same, and there are 32. */
static __attribute__((noinline)) void run_killed(uint32_t motor, struct motor* m, struct loop* l) {
  desired_path_take_actual(motor);
  m->output = 0;
  l->integral = l->step = l->filtered = 0; /* shown so while it is open */
  const hal_place words = words_of(motor);
  const int64_t actual = m->actual;
  publish_position(words, MEMORY_MOTOR_COMMANDED, actual);
  publish_position(words, MEMORY_MOTOR_ACTUAL, actual);
  publish_numbers(words, m->velocity, 0);
}

static __attribute__((noinline)) void run_other(uint32_t motor, struct motor* m, struct loop* l) {
  if (m->loop == LOOP_CLOSED) {
    close_loop(motor, m, l);
  } else {
    desired_path_take_actual(motor);
    m->output = m->open_output;
    l->integral = l->step = l->filtered = 0; /* shown so while it is open */
  }
  publish(motor, m);
}

/* The call is the last thing, so that what does not need it saves no registers. */
void position_loop_servo(uint32_t motor) {
  struct motor* m = &motors[motor];
  struct loop* l = &loops[motor];
  FIXED_IN_REGISTER(m);
  FIXED_IN_REGISTER(l);
  if (l->left != 0u) {
    l->left--;
    if (__builtin_expect(l->forgets != 0u, 0)) forget_interrupt(l);
    return;
  }
  l->left = l->extension;
  measure(m, l);
  if (m->loop == LOOP_CLOSED && close_simple_loop(motor, m, l)) return;
  if (m->loop == LOOP_KILLED)
    run_killed(motor, m, l);
  else
    run_other(motor, m, l);
}

/* What live words show ----------------------------------------------------------------------------------------------
 */

static int64_t of_one_moment(const int64_t* value) {
  const uint32_t state = hal_mask_servo();
  const int64_t copy = *value;
  hal_unmask(state);
  return copy;
}

uint32_t position_loop_reading(uint32_t motor) { return loops[motor].position_reading; }
int64_t position_loop_measured(uint32_t motor) {
  const struct loop* l = &loops[motor];
  const int64_t movement = hal_signed(*l->position_source - l->position_reading);
  return motors[motor].actual + movement * motors[motor].position_scale;
}
void position_loop_forget_movement(uint32_t motor) { loops[motor].forgets = FORGETS; }
int32_t position_loop_filtered(uint32_t motor) {
  return (int32_t)fixed_within_long(of_one_moment(&loops[motor].filtered) >> NOTCH_FINER, WORD_MOST);
}
int64_t position_loop_integral(uint32_t motor) { return of_one_moment(&loops[motor].integral) >> INTEGRAL_BITS; }
int64_t position_loop_step(uint32_t motor) { return of_one_moment(&loops[motor].step); }
bool position_loop_is_limited(uint32_t motor) {
  const struct loop* l = &loops[motor];
  return l->integral_most != 0 && (l->integral == l->integral_most || l->integral == -l->integral_most);
}
