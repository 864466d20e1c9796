#include "firmware/motion/lookahead.h"

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/lookahead_limits.h"
#include "firmware/motion/lookahead_state.h"
#include "firmware/motion/system_motors.h"
#include "firmware/variables/i_variables.h"

enum {
  LEAST = 4,      /* records ahead that make sense */
  SCALE_BITS = 30 /* of the mantissa of a motor's scale */
};

/* Of a motor: x' and x'' as limits_motor has them are differences of points times mantissa / 2^shift; the largest
 * difference that Ixx16 allows. 0: no limit. */
static struct {
  int32_t mantissa;
  uint32_t shift;
  int64_t fastest;
} scales[MOTORS];

/* Room for segments behind the three points that it takes besides. */
uint32_t lookahead_capacity(uint32_t cs, uint32_t motor_count) {
  struct lookahead_buffer buffer;
  lookahead_buffer_open(cs, motor_count, &buffer);
  return buffer.records < LOOKAHEAD_KEPT + LEAST ? 0u : buffer.records - LOOKAHEAD_KEPT;
}

static uint32_t count_bits(uint32_t mask) {
  uint32_t count = 0;
  for (; mask != 0; mask &= mask - 1u) count++;
  return count;
}

static void set_scale(uint32_t motor, double period) {
  const double velocity = system_motor_velocity(motor), acceleration = system_motor_acceleration(motor);
  slice_pause();
  scales[motor].fastest = velocity > 0.0 ? math_nearest(velocity * period) : 0;
  scales[motor].mantissa = 0;
  slice_pause();
  if (!(acceleration > 0.0)) return;
  double one = 1.0 / (acceleration * period * period) * (double)(1 << BEND_BITS);
  uint32_t shift = 0;
  slice_pause();
  while (one < (double)(1 << (SCALE_BITS - 1)) && shift < 62u) {
    one *= 2.0;
    shift++;
    slice_pause();
  }
  scales[motor].shift = shift;
  scales[motor].mantissa = one < (double)INT32_MAX ? (int32_t)one : INT32_MAX;
}

bool lookahead_begin(uint32_t cs, uint32_t period) {
  struct look* l = &looks[cs];
  const uint32_t wanted = (uint32_t)i_integer(i_cs(cs, ISX20_LOOKAHEAD_LENGTH));
  l->motors = coordinate_systems[cs].motors;
  const uint32_t motor_count = count_bits(l->motors), room = lookahead_capacity(cs, motor_count);
  if (wanted == 0 || room == 0) return false;
  lookahead_buffer_open(cs, motor_count, &l->buffer);
  l->length = wanted < room ? wanted : room;
  if (l->length < LEAST) l->length = LEAST;
  l->limits = wanted > 1u;
  l->closed = l->begun = l->backward = l->single = l->was_single = false;
  l->added = l->front = l->part = 0;
  l->rate = RATE_FULL;
  l->state = LOOK_GOES;
  l->next = LOOKAHEAD_NONE;
  look_forget_sweeps(l);
  l->period = (double)period;
  for (uint32_t motor = 0, left = l->motors; left != 0; motor++, left >>= 1)
    if ((left & 1u) != 0) set_scale(motor, l->period);
  return true;
}

uint32_t lookahead_left(uint32_t cs) { return look_end(&looks[cs]) - looks[cs].front; }

bool lookahead_is_full(uint32_t cs) {
  const struct look* l = &looks[cs];
  if (l->backward) return true; /* what is behind is needed */
  return look_end(l) - l->front >= l->length || l->added - l->front >= l->buffer.records - LOOKAHEAD_KEPT / 2;
}

void lookahead_close(uint32_t cs) { looks[cs].closed = true; }

static int32_t scaled(uint32_t motor, int64_t difference) {
  uint32_t shift = scales[motor].shift;
  while (difference > INT32_MAX || difference < INT32_MIN) {
    if (shift == 0u) return difference > 0 ? BEND_MOST : -BEND_MOST;
    difference /= 2;
    shift--;
  }
  const int64_t value = (difference * scales[motor].mantissa) >> shift;
  return value > BEND_MOST ? BEND_MOST : value < -BEND_MOST ? -BEND_MOST : (int32_t)value;
}

/* (fastest / way)^2 */
static int32_t cap_of(int64_t fastest, int64_t way) {
  if (fastest == 0 || way <= fastest) return RATE_FULL;
  slice_pause();
  const double part = (double)fastest / (double)way;
  slice_pause();
  return (int32_t)(part * part * (double)RATE_FULL);
}

static int64_t magnitude(int64_t value) { return value < 0 ? -value : value; }

/* With its third point a knot is known, with the fourth the segment before that. */
static void set_limits(struct look* l, uint32_t at, uint32_t motor, uint32_t slot) {
  if (at < 2u) return;
  struct lookahead_motor* knot = &lookahead_motors(&l->buffer, at - 2u)[slot];
  const int64_t first = lookahead_motors(&l->buffer, at - 1u)[slot].point - knot->point;
  const int64_t second = lookahead_motors(&l->buffer, at)[slot].point - first - knot->point;
  knot->pace = scaled(motor, first + second) / 2;
  slice_pause();
  knot->bend = scaled(motor, second - first);
  if (at < 3u) return;
  /* x' of the segment has these for Bernstein coefficients: it is nowhere larger */
  const int64_t before = knot->point - lookahead_motors(&l->buffer, at - 3u)[slot].point;
  int64_t most = magnitude(first);
  if (magnitude(before + first) / 2 > most) most = magnitude(before + first) / 2;
  if (magnitude(first + second) / 2 > most) most = magnitude(first + second) / 2;
  slice_pause();
  struct lookahead_record* segment = lookahead_at(&l->buffer, at - 3u);
  const int32_t cap = cap_of(scales[motor].fastest, most);
  if (cap < segment->cap) segment->cap = cap;
  slice_pause();
}

void lookahead_add(uint32_t cs, const int64_t point[], uint32_t number, const struct path_line* line) {
  struct look* l = &looks[cs];
  const uint32_t at = l->added;
  struct lookahead_record* record = lookahead_at(&l->buffer, at);
  record->rate = 0;
  record->cap = RATE_FULL;
  record->number = number;
  record->line = *line;
  struct lookahead_motor* motors = lookahead_motors(&l->buffer, at);
  for (uint32_t motor = 0, slot = 0, left = l->motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    motors[slot] = (struct lookahead_motor){point[motor], 0, 0};
    if (l->limits) set_limits(l, at, motor, slot);
    slot++;
  }
  l->added++;
}

void lookahead_points(uint32_t cs, uint32_t segment, uint32_t motor, int64_t points[SPLINE_POINTS]) {
  const struct look* l = &looks[cs];
  const uint32_t slot = count_bits(l->motors & ((1u << motor) - 1u));
  for (uint32_t i = 0; i < SPLINE_POINTS; i++) points[i] = lookahead_motors(&l->buffer, segment + i)[slot].point;
}
