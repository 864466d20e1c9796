#include "firmware/motion/lookahead_limits.h"

#include "firmware/base/dimensions.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/fixed_ratio.h"

enum { PAUSE_MOTORS = 4, VALUES = 6, SEARCHES = 4 };
enum { NEAR_ENOUGH = 4 }; /* 2^-4 of a w */

/* Products are kept to 32 bits: 1 is 2^12 then, and sums are up to three less. A sweep keeps so much inside of the
 * limits that rounding leaves a way for what is chosen by it. */
enum { PRODUCT_BITS = RATE_BITS + BEND_BITS - 32, ROUNDING = 4, SWEEP_INSIDE = 16 };
enum { INSIDE = (1 << PRODUCT_BITS) - ROUNDING };

/* Of a motor: x'' at the ends of the part, and half of the Bernstein coefficients of x', in the part's own time. */
struct motor_part {
  int32_t bend[2], pace[3];
};
static struct motor_part motor_parts[MOTORS];
static uint32_t count;
static int32_t inside;  /* set by whoever is asked: an abort leaves in the middle of it */
static uint32_t likely; /* the motor that has been the narrowest last */

static int32_t magnitude(int32_t value) { return value < 0 ? -value : value; }

/* All below half of the limit: with w up to 1 it holds anyway. */
static inline bool is_slow(const struct motor_part* m) {
  const uint32_t half = 1u << (BEND_BITS - 1);
  const uint32_t bend = ((uint32_t)m->bend[0] + half) | ((uint32_t)m->bend[1] + half);
  const uint32_t pace = ((uint32_t)m->pace[0] + half) | ((uint32_t)m->pace[1] + half);
  return (bend | pace | ((uint32_t)m->pace[2] + half)) < 2u * half;
}

void limits_load(const struct lookahead_motor* at, const struct lookahead_motor* next, uint32_t motor_count) {
  count = 0;
  for (uint32_t i = 0; i < motor_count; i++) {
    struct motor_part* to = &motor_parts[count];
    const int32_t bend = at[i].bend, pace = at[i].pace >> 1;
    to->bend[0] = bend;
    to->bend[1] = next[i].bend;
    to->pace[0] = pace;
    to->pace[1] = pace + (bend >> 2);
    to->pace[2] = next[i].pace >> 1;
    if (!is_slow(to)) count++;
    if (i % PAUSE_MOTORS == PAUSE_MOTORS - 1u) slice_pause();
  }
}

void limits_load_part(const struct lookahead_motor* at, const struct lookahead_motor* next, uint32_t motor_count,
                      uint32_t first, uint32_t last) {
  const int32_t parts = (int32_t)(last - first);
  count = 0;
  for (uint32_t i = 0; i < motor_count; i++) {
    struct motor_part* to = &motor_parts[count];
    const int64_t bend = at[i].bend, turn = next[i].bend - bend;
    for (uint32_t end = 0; end < 2u; end++) {
      const int64_t s = end == 0 ? first : last;
      to->bend[end] = (int32_t)(bend + turn * s / PIECE_PARTS);
      slice_pause();
      const int64_t pace = at[i].pace + (bend * 2 * PIECE_PARTS + turn * s) * s / (2 * PIECE_PARTS * PIECE_PARTS);
      to->pace[end * 2u] = (int32_t)pace / parts * (PIECE_PARTS / 2);
    }
    to->pace[1] = to->pace[0] + to->bend[0] / 4;
    if (!is_slow(to)) count++;
  }
}

/* The middle coefficients of the quarters, in eighths of those of the whole. */
static const int8_t quarters[VALUES - 2][3] = {{6, 2, 0}, {3, 4, 1}, {1, 4, 3}, {0, 2, 6}};

static int32_t mean(int32_t b0, int32_t b1, int32_t b2, const int8_t part[3]) {
  return (b0 >> 3) * part[0] + (b1 >> 3) * part[1] + (b2 >> 3) * part[2];
}

/* |c[0] w0 + c[1] w1| <= 1, on the side where that is met. */
struct edge {
  int32_t c[2];
  bool above;
};

/* What the limits leave for the w at one end. */
struct room {
  int32_t most;      /* below 0: nothing */
  uint32_t by;       /* the motor that has narrowed it last, which need not be tried again; MOTORS: none has */
  bool narrowed;     /* by `upper` */
  struct edge upper; /* what says so */
  struct edge lower; /* of nothing: what asks for more */
};

/* Of x'' w + x' w' / 2 at w0 and w1. */
struct values {
  int32_t b[3]; /* Bernstein coefficients */
};
static inline bool is_within(int32_t value, int32_t most) { return value <= most && value >= -most; }

/* Those of the ends are values; between them that of the middle bounds all that is. */
static inline bool holds(const struct motor_part* m, int32_t w0, int32_t w1, int32_t most, struct values* v) {
  const int32_t h = w1 - w0, a0 = m->bend[0], a1 = m->bend[1];
  v->b[0] = fixed_high(a0, w0) + fixed_high(m->pace[0], h);
  v->b[2] = fixed_high(a1, w1) + fixed_high(m->pace[2], h);
  v->b[1] = ((fixed_high(a1, w0) + fixed_high(a0, w1)) >> 1) + fixed_high(m->pace[1], h);
  return is_within(v->b[0], most) && is_within(v->b[1], most) && is_within(v->b[2], most);
}

/* Whether a value is beyond its limit on a side that is not among `met`. */
static inline bool is_out(int32_t b, uint32_t value, uint32_t met) {
  return !is_within(b, inside) && (met >> (2u * value + (b > 0 ? 1u : 0u)) & 1u) == 0;
}

/* A value of the two ends, or of the quarters, that is out; VALUES: none. */
static uint32_t beyond(const struct values* v, uint32_t met) {
  const int32_t* b = v->b;
  if (is_out(b[0], 0, met)) return 0;
  if (is_out(b[2], VALUES - 1u, met)) return VALUES - 1u;
  if (is_within(b[1], inside)) return VALUES;
  const int32_t from = 3 * b[0], to = 3 * b[2], middle = 4 * b[1]; /* as `quarters` has it */
  if (is_out((from + b[1]) >> 2, 1, met)) return 1;
  if (is_out((from + middle + b[2]) >> 3, 2, met)) return 2;
  if (is_out((b[0] + middle + to) >> 3, 3, met)) return 3;
  return is_out((b[1] + to) >> 2, 4, met) ? 4u : VALUES;
}

/* On which side a value was out. */
static inline uint32_t side_of(const struct edge* e, int32_t w0, int32_t w1) {
  return fixed_high(e->c[0], w0) + fixed_high(e->c[1], w1) > 0 ? 1u : 0u;
}

static struct edge edge_of(const struct motor_part* m, uint32_t value) {
  const int32_t a0 = m->bend[0], a1 = m->bend[1], *n = m->pace;
  if (value == 0) return (struct edge){{a0 - n[0], n[0]}, false};
  if (value == VALUES - 1u) return (struct edge){{-n[2], a1 + n[2]}, false};
  const int8_t* of = quarters[value - 1u];
  return (struct edge){{mean(a0 - n[0], a1 / 2 - n[1], -n[2], of), mean(n[0], a0 / 2 + n[1], a1 + n[2], of)}, false};
}

/* w * 2^32 / by, for w >= 0 */
static int32_t divide(int32_t w, int32_t by) {
  const uint32_t size = (uint32_t)magnitude(by);
  return (uint32_t)w >= size / 2u ? INT32_MAX : (int32_t)fixed_fraction((uint32_t)w, size);
}

/* False: it leaves nothing. */
static bool narrow(enum limits_end end, struct edge e, int32_t w, struct room* r) {
  const int32_t given = fixed_high(e.c[1 - end], w), by = e.c[end], sum = given + fixed_high(by, r->most);
  if (sum <= inside && sum >= -inside) return true;
  e.above = sum > 0;
  if (by == 0 || (by > 0) != e.above) {
    if (sum <= inside + ROUNDING && sum >= -inside - ROUNDING) return true;
    r->lower = e;
    return false;
  }
  const int32_t left = e.above ? inside - given : inside + given;
  r->upper = e;
  r->narrowed = true;
  r->most = left < 0 ? (left < -6 ? -1 : 0) : divide(left, by);
  if (r->most >= 0) return true;
  r->lower = r->upper;
  return false;
}

static inline bool holds_at(enum limits_end end, const struct motor_part* m, int32_t w, int32_t other,
                            struct values* v) {
  return end == LIMITS_FIRST ? holds(m, other, w, inside, v) : holds(m, w, other, inside, v);
}

/* What narrows is met, a little more or less by rounding; on its other side it may still be out. */
static __attribute__((noinline)) bool narrow_by_motor(enum limits_end end, uint32_t i, int32_t w, struct room* r,
                                                      struct values* v) {
  const struct motor_part* m = &motor_parts[i];
  slice_pause();
  for (uint32_t met = 0;;) {
    const uint32_t value = beyond(v, met);
    if (value == VALUES) return true;
    const struct edge edge = edge_of(m, value);
    const uint32_t side = end == LIMITS_FIRST ? side_of(&edge, r->most, w) : side_of(&edge, w, r->most);
    if (!narrow(end, edge, w, r)) return false;
    likely = r->by = i;
    slice_pause();
    met |= 1u << (2u * value + side);
    if (holds_at(end, m, w, r->most, v)) return true;
  }
}

/* Of the first `number` motors. */
static bool pass(enum limits_end end, int32_t w, struct room* r, uint32_t number) {
  struct values v;
  for (uint32_t i = 0; i < number; i++) {
    if (i != r->by && !holds_at(end, &motor_parts[i], w, r->most, &v) && !narrow_by_motor(end, i, w, r, &v))
      return false;
    if (i % PAUSE_MOTORS == 1u) slice_pause();
  }
  return true;
}

/* What has been narrowed on the way is looked at again by the motors that came before. The one that was the narrowest
 * last comes first, and mostly is so again. */
static struct room room_of(enum limits_end end, int32_t w, int32_t most) {
  struct room r = {.most = most, .by = MOTORS};
  struct values v;
  bool possible =
      likely >= count || holds_at(end, &motor_parts[likely], w, most, &v) || narrow_by_motor(end, likely, w, &r, &v);
  int32_t begun = r.most;
  possible = possible && pass(end, w, &r, count);
  if (possible && r.most != begun) {
    begun = r.most;
    possible = pass(end, w, &r, r.by);
    if (possible && r.most != begun) possible = pass(end, w, &r, count);
  }
  if (!possible) r.most = -1;
  slice_pause();
  return r;
}

int32_t limits_most(enum limits_end end, int32_t w, int32_t most) {
  inside = INSIDE;
  return room_of(end, w, most).most;
}

/* Raised by what asks for more than `least`. False: nothing that is more helps. */
static bool raise(enum limits_end end, const struct edge* e, int32_t w, int32_t* least) {
  const int32_t given = fixed_high(e->c[1 - end], w), by = e->c[end], sum = given + fixed_high(by, *least);
  if (sum <= inside && sum >= -inside) return true;
  const bool above = sum > 0;
  if (by == 0 || (by > 0) == above) return sum <= inside + ROUNDING && sum >= -inside - ROUNDING;
  const int32_t asked = divide(above ? given - inside : -inside - given, by);
  if (asked >= *least) *least = asked < INT32_MAX ? asked + 1 : asked;
  return true;
}

int32_t limits_least(enum limits_end end, int32_t w, int32_t most) {
  int32_t least = 0;
  inside = INSIDE;
  for (uint32_t i = 0; i < count; i++) {
    for (uint32_t value = 0; value < VALUES; value++) {
      const struct edge e = edge_of(&motor_parts[i], value);
      if (!raise(end, &e, w, &least)) return -1;
      slice_pause();
    }
  }
  return least > most ? -1 : least;
}

int32_t limits_change(void) {
  int32_t largest = 0;
  for (uint32_t i = 0; i < count; i++)
    for (uint32_t k = 0; k < 3u; k++)
      if (magnitude(motor_parts[i].pace[k]) > largest) largest = magnitude(motor_parts[i].pace[k]);
  return largest == 0 ? INT32_MAX : divide(INSIDE, largest);
}

/* The w at the other end at which two limits are met at once; below 0: none from 0 to 1. */
static int32_t meeting(enum limits_end end, const struct edge* a, const struct edge* b) {
  int64_t over = (a->above ? b->c[end] : -(int64_t)b->c[end]);
  over = (b->above ? a->c[end] : -(int64_t)a->c[end]) - over;
  int64_t by = (int64_t)a->c[end] * b->c[1 - end] - (int64_t)b->c[end] * a->c[1 - end];
  if (by < 0) {
    by = -by;
    over = -over;
  }
  over *= 1 << BEND_BITS;
  if (over <= 0 || over > by) return -1;
  return (int32_t)(fixed_ratio(over, by) >> (62 - RATE_BITS));
}

static bool rises(enum limits_end end, const struct room* r) {
  const int32_t* c = r->upper.c;
  return !r->narrowed || c[1 - end] == 0 || (c[end] > 0) != (c[1 - end] > 0);
}

/* What can be reached is concave in the w at the other end, and exists at 0: between a place where it rises and one
 * where it falls, or is not, the limits that are met at both meet nearer to the largest. */
static int32_t search(enum limits_end end, int32_t other, int32_t most) {
  struct room high = room_of(end, other, most);
  if (high.most >= 0 && rises(end, &high)) return high.most;
  struct room low = room_of(end, 0, most);
  int32_t from = 0, to = other, best = high.most > low.most ? high.most : low.most;
  for (uint32_t i = 0; i < SEARCHES && to - from > (to >> NEAR_ENOUGH) + 1; i++) {
    const struct edge* edge = high.most < 0 ? &high.lower : &high.upper;
    const bool same = edge->c[0] == high.upper.c[0] && edge->c[1] == high.upper.c[1];
    int32_t w = meeting(end, high.most < 0 && high.narrowed && !same ? &high.upper : &low.upper, edge);
    slice_pause();
    if (w <= from || w >= to || (i & 1u) != 0) w = from + (to - from) / 2;
    const struct room r = room_of(end, w, most);
    if (r.most >= 0 && rises(end, &r)) {
      low = r;
      from = w;
    } else {
      high = r;
      to = w;
    }
    if (r.most > best) {
      const bool near = best > r.most - (r.most >> NEAR_ENOUGH) && i != 0;
      best = r.most;
      if (near) break;
    }
  }
  return best > 0 ? best : 0;
}

int32_t limits_reach(enum limits_end end, int32_t other, int32_t most) {
  inside = INSIDE - SWEEP_INSIDE;
  return search(end, other, most);
}
