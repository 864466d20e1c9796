#include "firmware/motion/lookahead.h"

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/lookahead_buffer.h"
#include "firmware/motion/lookahead_limits.h"
#include "firmware/motion/system_motors.h"
#include "firmware/variables/i_variables.h"

enum {
  KEPT = 8,       /* records behind the front that are not written over */
  LEAST = 4,      /* records ahead that make sense */
  SCALE_BITS = 30 /* of the mantissa of a motor's scale */
};

struct look {
  struct lookahead_buffer buffer;
  uint32_t length; /* Isx20, as far as the buffer has room */
  bool limits;     /* Isx20 above 1 */
  bool closed;
  uint32_t added, front; /* points so far; the next segment to be handed over */
  uint32_t swept;        /* the end of the last sweep */
  uint32_t good;         /* knots up to this one do not depend on where that stopped */
  bool sweeping;
  uint32_t sweep, sweep_end; /* the last knot that it has done; where it began */
  uint32_t motors;
  double period;
};

static struct look looks[COORDINATE_SYSTEMS];

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
  return buffer.records < KEPT + LEAST ? 0u : buffer.records - KEPT;
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
  l->closed = l->sweeping = false;
  l->added = l->front = l->swept = l->good = 0;
  l->period = (double)period;
  for (uint32_t motor = 0, left = l->motors; left != 0; motor++, left >>= 1)
    if ((left & 1u) != 0) set_scale(motor, l->period);
  return true;
}

/* The last knot, behind which nothing is known. */
static uint32_t end_of(const struct look* l) { return l->added < SPLINE_POINTS ? 0u : l->added - SPLINE_POINTS + 1u; }

uint32_t lookahead_left(uint32_t cs) { return end_of(&looks[cs]) - looks[cs].front; }

bool lookahead_is_full(uint32_t cs) {
  const struct look* l = &looks[cs];
  return end_of(l) - l->front >= l->length || l->added - l->front >= l->buffer.records - KEPT / 2;
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
  struct lookahead_record* segment = lookahead_record(&l->buffer, at - 3u);
  const int32_t cap = cap_of(scales[motor].fastest, most);
  if (cap < segment->cap) segment->cap = cap;
  slice_pause();
}

void lookahead_add(uint32_t cs, const int64_t point[], uint32_t number, const struct path_line* line) {
  struct look* l = &looks[cs];
  const uint32_t at = l->added;
  struct lookahead_record* record = lookahead_record(&l->buffer, at);
  record->rate = at == 0 ? RATE_FULL : 0;
  record->cap = RATE_FULL;
  record->number = number;
  record->line = *line;
  struct lookahead_motor* motors = lookahead_motors(&l->buffer, at);
  for (uint32_t motor = 0, slot = 0, left = l->motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    motors[slot].point = point[motor];
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

/* The whole segment. */
static void load(const struct look* l, uint32_t segment) {
  const struct lookahead_motor *first = lookahead_motors(&l->buffer, segment),
                               *second = lookahead_motors(&l->buffer, segment + 1u);
  limits_begin();
  for (uint32_t slot = 0, left = l->motors; left != 0; left &= left - 1u, slot++) {
    const struct limits_motor m = {{first[slot].pace, second[slot].pace}, {first[slot].bend, second[slot].bend}};
    limits_add(&m, 4);
  }
}

/* Of w at a knot: the velocities in the segments at both sides. */
static int32_t cap_at(const struct look* l, uint32_t knot) {
  const int32_t behind = knot == 0 ? RATE_FULL : lookahead_record(&l->buffer, knot - 1u)->cap;
  const int32_t ahead = knot == end_of(l) ? RATE_FULL : lookahead_record(&l->buffer, knot)->cap;
  return behind < ahead ? behind : ahead;
}

/* A part of the length that the last one third of the window leaves for where it had to stop. */
static uint32_t spare(const struct look* l) { return l->length / 4u != 0 ? l->length / 4u : 1u; }

static void begin_sweep(struct look* l) {
  l->sweeping = true;
  l->sweep = l->sweep_end = end_of(l);
  lookahead_record(&l->buffer, l->sweep)->rate = l->closed ? cap_at(l, l->sweep) : 0;
}

static void end_sweep(struct look* l) {
  l->sweeping = false;
  l->swept = l->sweep_end;
  const uint32_t doubtful = l->length - spare(l);
  const bool whole = l->closed && l->swept == end_of(l);
  l->good = whole ? l->swept : l->swept > doubtful ? l->swept - doubtful : 0u;
}

bool lookahead_sweep(uint32_t cs, bool hurry) {
  struct look* l = &looks[cs];
  const uint32_t end = end_of(l), last = l->front == 0 ? 0u : l->front + 1u; /* at its first knot it may have any w */
  if (!l->limits || end <= l->front) return false;
  if (!l->sweeping) {
    const bool due = end - l->swept >= spare(l) && (lookahead_is_full(cs) || hurry);
    const bool closes = l->closed && l->good < end;
    if (!due && !closes && !(hurry && end > l->swept)) return false;
    begin_sweep(l);
    return true;
  }
  if (l->sweep <= last) {
    end_sweep(l);
    return true;
  }
  const uint32_t knot = l->sweep - 1u;
  struct lookahead_record* record = lookahead_record(&l->buffer, knot);
  load(l, knot);
  const int32_t rate = limits_reach(LIMITS_FIRST, lookahead_record(&l->buffer, l->sweep)->rate, cap_at(l, knot));
  l->sweep = knot;
  if (rate == record->rate && knot < l->swept) l->sweep = l->front; /* from here on all is as it was */
  record->rate = rate;
  return true;
}

/* 2 T / (root w0 + root w1); the share of its time and that of the way differ by warp u (1 - u). */
static void set_time(const struct look* l, int32_t w0, int32_t w1, struct lookahead_piece* piece) {
  const double first = math_square_root((double)w0), second = w1 == w0 ? first : math_square_root((double)w1);
  slice_pause();
  const double sum = first + second;
  slice_pause();
  const double time = 2.0 * l->period / sum * (double)(1 << (RATE_BITS / 2));
  slice_pause();
  piece->time = math_to_integer(
      math_scale(time < TRAJECTORY_LONGEST_MS ? time : TRAJECTORY_LONGEST_MS, TRAJECTORY_FRACTION_BITS));
  slice_pause();
  piece->warp = (int32_t)math_to_integer((first - second) / sum * (double)PIECE_WARP_ONE);
}

/* Whether the front may go on: what the sweep says of the next knot is not about its own end, or time runs short. */
static bool may_go_on(const struct look* l, bool hurry) {
  if (l->front >= end_of(l)) return false;
  if (!l->limits) return true;
  if (l->front + 1u <= l->good) return true;
  if (!hurry || l->front + 1u > l->swept) return false;
  return !l->sweeping || lookahead_record(&l->buffer, l->front + 1u)->rate != 0;
}

bool lookahead_release(uint32_t cs, bool hurry, struct lookahead_piece* piece) {
  struct look* l = &looks[cs];
  if (!may_go_on(l, hurry)) return false;
  const uint32_t segment = l->front;
  struct lookahead_record *first = lookahead_record(&l->buffer, segment),
                          *second = lookahead_record(&l->buffer, segment + 1u);
  int32_t w1 = RATE_FULL;
  if (l->limits) {
    load(l, segment);
    w1 = limits_most(LIMITS_SECOND, first->rate, second->rate);
    if (w1 < 0) w1 = second->rate;
    if (w1 == 0 && first->rate == 0) return false;
  }
  second->rate = w1;
  piece->segment = segment;
  if (first->rate == RATE_FULL && w1 == RATE_FULL) {
    piece->time = (int64_t)(uint32_t)l->period << TRAJECTORY_FRACTION_BITS;
    piece->warp = 0;
  } else {
    set_time(l, first->rate, w1, piece);
  }
  piece->number = lookahead_record(&l->buffer, segment + 2u)->number;
  piece->line = lookahead_record(&l->buffer, segment + 2u)->line;
  l->front++;
  return true;
}
