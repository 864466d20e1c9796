#include "firmware/motion/lookahead.h"

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/fixed_ratio.h"
#include "firmware/motion/lookahead_limits.h"
#include "firmware/motion/lookahead_state.h"
#include "firmware/motion/protection.h"
#include "firmware/motion/system_motors.h"
#include "firmware/variables/i_variables.h"

enum {
  LEAST = 4, /* records ahead that make sense */
  SCALE_BITS = 16,
  STEP_MOST = 1 << 29, /* 2^13 of the smaller limit */
  SATURATES = 1 << 14  /* Ixx24: on at the limit of a desired position */
};

#define SCALE_HALF 32768.0

/* Of a motor. Steps from point to point are shifted by `coarse`, to the right, so that the smaller of the limits, of
 * the velocity and of the acceleration in the time of one, has 2^15 to 2^16; x' and x'' as limits_motor has them are
 * those times mantissa / 2^32. */
static struct {
  int32_t mantissa; /* 0: no limit */
  int32_t coarse;
  int32_t fastest;         /* the largest step that Ixx16 allows; 0: no limit */
  int32_t before, last;    /* the last two steps */
  int64_t lowest, highest; /* of the desired position, Ixx24 bit 15 */
  int64_t held;            /* by which it holds the last point back */
  bool saturates;          /* bit 14 */
} scales[MOTORS];

/* Room for segments behind the three points that it takes besides. */
static uint32_t capacity(const struct lookahead_buffer* buffer) {
  return buffer->records < LOOKAHEAD_KEPT + LEAST ? 0u : buffer->records - LOOKAHEAD_KEPT;
}

static uint32_t count_bits(uint32_t mask) {
  uint32_t count = 0;
  for (; mask != 0; mask &= mask - 1u) count++;
  return count;
}

static void set_scale(uint32_t motor, double period) {
  slice_pause();
  double velocity = system_motor_velocity(motor);
  slice_pause();
  velocity *= period;
  slice_pause();
  double acceleration = system_motor_acceleration(motor);
  slice_pause();
  acceleration *= period;
  acceleration *= period;
  slice_pause();
  const bool limited = acceleration > 0.0;
  double one = limited ? acceleration : velocity > 0.0 ? velocity : 1.0;
  if (velocity > 0.0 && velocity < one) one = velocity;
  int32_t coarse = 0;
  for (; one > 2.0 * SCALE_HALF; coarse++) {
    one = math_scale(one, -1);
    slice_pause();
  }
  for (; one <= SCALE_HALF && coarse > -SCALE_BITS; coarse--) {
    one = math_scale(one, 1);
    slice_pause();
  }
  scales[motor].coarse = coarse;
  scales[motor].before = scales[motor].last = 0;
  const double fastest = math_scale(velocity, -coarse);
  scales[motor].fastest = fastest > (double)STEP_MOST ? 0 : (int32_t)fastest;
  if (velocity > 0.0 && fastest < 1.0) scales[motor].fastest = 1;
  slice_pause();
  acceleration = math_scale(acceleration, -coarse);
  const double inverse = limited ? 1.0 / acceleration : 0.0;
  slice_pause();
  const double mantissa = math_scale(inverse, 32 + BEND_BITS);
  scales[motor].mantissa = !limited ? 0 : mantissa < (double)INT32_MAX ? (int32_t)mantissa : INT32_MAX;
}

/* Whether there is one. */
static bool set_guard(uint32_t motor) {
  const uint32_t mode = (uint32_t)i_integer(i_motor(motor + 1u, IXX24_FLAG_MODE));
  scales[motor].saturates = (mode & SATURATES) != 0u;
  return protection_desired_limits(motor, &scales[motor].lowest, &scales[motor].highest);
}

bool lookahead_begin(uint32_t cs, uint32_t period) {
  struct look* l = &looks[cs];
  const uint32_t wanted = (uint32_t)i_integer(i_cs(cs, ISX20_LOOKAHEAD_LENGTH));
  l->motors = coordinate_systems[cs].motors;
  l->motor_count = count_bits(l->motors);
  lookahead_buffer_open(cs, l->motor_count, &l->buffer);
  const uint32_t room = capacity(&l->buffer);
  if (wanted == 0 || room == 0) return false;
  l->length = wanted < room ? wanted : room;
  if (l->length < LEAST) l->length = LEAST;
  l->limits = wanted > 1u;
  l->closed = l->begun = l->backward = l->single = l->was_single = false;
  l->added = l->front = l->part = 0;
  l->guarded = 0;
  l->rate = l->rooted = RATE_FULL;
  l->root = RATE_FULL;
  l->state = LOOK_GOES;
  l->next = LOOKAHEAD_NONE;
  look_forget_sweeps(l);
  l->period = period;
  for (uint32_t motor = 0, left = l->motors; left != 0; motor++, left >>= 1)
    if ((left & 1u) != 0) {
      set_scale(motor, (double)period);
      slice_pause();
      if (l->limits && set_guard(motor)) l->guarded |= 1u << motor;
    }
  return true;
}

bool lookahead_is_full(uint32_t cs) {
  const struct look* l = &looks[cs];
  if (l->backward) return true; /* what is behind is needed */
  return look_end(l) - l->front >= l->length || l->added - l->front >= l->buffer.records - LOOKAHEAD_KEPT / 2;
}

/* The axes are where the program has them: a motor that is held comes along with the next move. */
void lookahead_close(uint32_t cs) {
  struct look* l = &looks[cs];
  l->closed = true;
  for (uint32_t motor = 0, left = l->guarded; left != 0; motor++, left >>= 1)
    if ((left & 1u) != 0) system_motor_stands_aside(motor, scales[motor].held);
}

/* (fastest / way)^2 */
static int32_t cap_of(int32_t fastest, int32_t way) {
  const int64_t part = fixed_ratio(fastest, way) >> (62 - RATE_BITS);
  slice_pause();
  return (int32_t)(part * part >> RATE_BITS);
}

static int32_t coarse_step(uint32_t motor, int64_t step) {
  const int32_t coarse = scales[motor].coarse;
  if (coarse >= 0) step >>= coarse;
  step = fixed_within_long(step, STEP_MOST);
  if (coarse < 0) step = fixed_within_long(step * (INT64_C(1) << -coarse), STEP_MOST);
  return (int32_t)step;
}

static int32_t magnitude(int32_t value) { return value < 0 ? -value : value; }
static int32_t larger(int32_t a, int32_t b) { return a > b ? a : b; }

/* x' of the segment has these for Bernstein coefficients: it is nowhere larger. */
static int32_t largest(int32_t before, int32_t step, int32_t next) {
  return larger(magnitude(step), larger(magnitude(before + step), magnitude(step + next)) / 2);
}

/* With its third point a knot is known, with the fourth the segment before that. */
static void set_limits(struct look* l, uint32_t motor, int32_t next, struct lookahead_motor* knot,
                       struct lookahead_record* segment) {
  const int32_t step = scales[motor].last, fastest = scales[motor].fastest;
  knot->pace = fixed_high(step + next, scales[motor].mantissa) / 2;
  knot->bend = fixed_high(next - step, scales[motor].mantissa);
  if (fastest == 0 || l->added < SPLINE_POINTS - 1u) return;
  const int32_t most = largest(scales[motor].before, step, next);
  if (most <= fastest) return;
  const int32_t cap = cap_of(fastest, most);
  if (cap < segment->cap) segment->cap = cap;
}

/* A sequence that begins beyond a limit does not go further out. */
static void widen(uint32_t motor, int64_t start) {
  if (start < scales[motor].lowest) scales[motor].lowest = start;
  if (start > scales[motor].highest) scales[motor].highest = start;
}

/* The limit instead of a point beyond it. With bit 14 = 0 it stands before the first segment that this changes: the
 * knot that was the last one until now. */
static int64_t guarded(uint32_t motor, int64_t point, struct lookahead_record* segment) {
  const int64_t lowest = scales[motor].lowest, highest = scales[motor].highest;
  scales[motor].held = 0;
  if (point >= lowest && point <= highest) return point;
  if (!scales[motor].saturates) segment->stops = true;
  const int64_t limit = point > highest ? highest : lowest;
  scales[motor].held = limit - point;
  return limit;
}

/* A point of the motors: with the one before it a step. */
static void add_point(struct look* l, struct lookahead_record* record, const int64_t control[][SPLINE_POINTS]) {
  const uint32_t at = l->added;
  struct lookahead_record *before = lookahead_before(&l->buffer, record), *two = lookahead_before(&l->buffer, before),
                          *segment = lookahead_before(&l->buffer, two);
  struct lookahead_motor *to = lookahead_of(record), *knot = lookahead_of(two);
  const struct lookahead_motor* last = lookahead_of(before);
  for (uint32_t motor = 0, slot = 0, left = l->motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    int64_t point = control[motor][SPLINE_POINTS - 1];
    if ((l->guarded >> motor & 1u) != 0) {
      if (at == 0) widen(motor, point);
      point = guarded(motor, point, at < SPLINE_POINTS - 1u ? record : segment);
    }
    to[slot] = (struct lookahead_motor){point, 0, 0};
    if (at != 0) {
      const int32_t step = coarse_step(motor, point - last[slot].point);
      if (at >= 2u) set_limits(l, motor, step, &knot[slot], segment);
      scales[motor].before = scales[motor].last;
      scales[motor].last = step;
    }
    slot++;
    if ((slot & 1u) == 0) slice_pause();
  }
}

void lookahead_add(uint32_t cs, const int64_t control[][SPLINE_POINTS], uint32_t number, const struct path_line* line) {
  struct look* l = &looks[cs];
  struct lookahead_record* record = lookahead_at(&l->buffer, l->added);
  record->rate = 0;
  record->cap = RATE_FULL;
  record->stops = false;
  record->number = number;
  record->line = *line;
  add_point(l, record, control);
  l->added++;
}

void lookahead_points(uint32_t cs, uint32_t segment, const struct lookahead_motor* points[SPLINE_POINTS]) {
  const struct lookahead_buffer* b = &looks[cs].buffer;
  struct lookahead_record* record = lookahead_at(b, segment);
  for (uint32_t i = 0; i < SPLINE_POINTS; i++, record = lookahead_behind(b, record)) points[i] = lookahead_of(record);
}
