#include "firmware/motion/lookahead_limits.h"

#include "firmware/base/dimensions.h"
#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/fixed_point.h"

enum { BOUNDS_A_MOTOR = 6, PAUSE_BOUNDS = 24, SEARCHES = 3 };
enum { NEAR_ENOUGH = 4 }; /* 2^-4 of a w */

/* Products are kept to 32 bits: 1 is 2^12 then, and sums are up to two less. A sweep keeps so much inside of the bounds
 * that rounding leaves a way for what is chosen by it. */
enum { PRODUCT_BITS = RATE_BITS + BEND_BITS - 32, ROUNDING = 4, SWEEP_INSIDE = 16 };

struct bound {
  int32_t c[2];
};
static struct bound bounds[MOTORS * BOUNDS_A_MOTOR];
static uint32_t count;
static int32_t inside = (1 << PRODUCT_BITS) - ROUNDING;
static uint32_t likely; /* the bound that has been the narrowest last */

void limits_begin(void) { count = 0; }

static int32_t magnitude(int32_t value) { return value < 0 ? -value : value; }

/* With w up to 1 the others hold anyway. */
static void add(int32_t c0, int32_t c1) {
  if (magnitude(c0) + magnitude(c1) < 1 << BEND_BITS) return;
  bounds[count++] = (struct bound){{c0, c1}};
}

/* Eighths of b0, b1, b2, each of which has bits to spare at the lower end. */
static int32_t mean(int32_t b0, int32_t b1, int32_t b2, const int8_t part[3]) {
  return (b0 >> 3) * part[0] + (b1 >> 3) * part[1] + (b2 >> 3) * part[2];
}

void limits_add(const struct limits_motor* m, uint32_t parts) {
  static const int8_t of[4][3] = {{6, 2, 0}, {3, 4, 1}, {1, 4, 3}, {0, 2, 6}};
  /* x' in the part's own time, halved: its Bernstein coefficients */
  const int32_t a0 = m->bend[0], a1 = m->bend[1];
  int32_t n0 = m->pace[0] / 2, n2 = m->pace[1] / 2;
  if (parts != 16u) {
    n0 = m->pace[0] / (int32_t)parts * 8;
    n2 = m->pace[1] / (int32_t)parts * 8;
  }
  const int32_t n1 = n0 + a0 / 4;
  const int32_t first[3] = {a0 - n0, a1 / 2 - n1, -n2}, second[3] = {n0, a0 / 2 + n1, a1 + n2};
  add(first[0], second[0]);
  for (uint32_t i = 0; i < 4u; i++)
    add(mean(first[0], first[1], first[2], of[i]), mean(second[0], second[1], second[2], of[i]));
  add(first[2], second[2]);
  slice_pause();
}

/* A bound that is met: on which side. */
struct edge {
  uint32_t bound;
  bool above;
};

/* What the bounds leave for the w at one end. */
struct room {
  int32_t most;      /* below 0: nothing */
  bool narrowed;     /* by `upper` */
  struct edge upper; /* the bound that says so */
  struct edge lower; /* of nothing: the one that asks for more */
};

/* w * 2^32 / by, for w >= 0 */
static int32_t divide(int32_t w, int32_t by) {
  const uint64_t quotient = ((uint64_t)(uint32_t)w << 32) / (uint32_t)magnitude(by);
  return quotient > (uint64_t)INT32_MAX ? INT32_MAX : (int32_t)quotient;
}

/* False: it leaves nothing. */
static bool narrow(enum limits_end end, uint32_t i, int32_t w, struct room* r) {
  const struct bound* b = &bounds[i];
  const int32_t given = fixed_high(b->c[1 - end], w), by = b->c[end], sum = given + fixed_high(by, r->most);
  if (sum <= inside && sum >= -inside) return true;
  const bool above = sum > 0;
  if (by == 0 || (by > 0) != above) {
    if (sum <= inside + ROUNDING && sum >= -inside - ROUNDING) return true;
    r->lower = (struct edge){i, above};
    return false;
  }
  const int32_t left = above ? inside - given : inside + given;
  r->upper = (struct edge){i, above};
  r->narrowed = true;
  r->most = left < 0 ? (left < -6 ? -1 : 0) : divide(left, by);
  likely = i;
  if (r->most >= 0) return true;
  r->lower = r->upper;
  return false;
}

static bool pass(enum limits_end end, int32_t w, struct room* r) {
  for (uint32_t i = 0; i < count; i++) {
    if (!narrow(end, i, w, r)) return false;
    if (i % PAUSE_BOUNDS == PAUSE_BOUNDS - 1u) slice_pause();
  }
  return true;
}

/* What has been narrowed on the way is looked at again by the bounds that came before. The one that was the narrowest
 * last comes first, and mostly is so again. */
static struct room room_of(enum limits_end end, int32_t w, int32_t most) {
  struct room r = {.most = most};
  bool possible = likely >= count || narrow(end, likely, w, &r);
  const int32_t begun = r.most;
  possible = possible && pass(end, w, &r);
  if (possible && r.most != begun) possible = pass(end, w, &r);
  if (!possible) r.most = -1;
  slice_pause();
  return r;
}

int32_t limits_most(enum limits_end end, int32_t w, int32_t most) { return room_of(end, w, most).most; }

int32_t limits_least(enum limits_end end, int32_t w, int32_t most) {
  int32_t least = 0;
  for (uint32_t i = 0; i < count; i++) {
    const struct bound* b = &bounds[i];
    const int32_t given = fixed_high(b->c[1 - end], w), by = b->c[end], sum = given + fixed_high(by, least);
    if (i % PAUSE_BOUNDS == PAUSE_BOUNDS - 1u) slice_pause();
    if (sum <= inside && sum >= -inside) continue;
    const bool above = sum > 0;
    if (by == 0 || (by > 0) == above) {
      if (sum <= inside + ROUNDING && sum >= -inside - ROUNDING) continue;
      return -1;
    }
    const int32_t asked = divide(above ? given - inside : -inside - given, by);
    if (asked >= least) least = asked < INT32_MAX ? asked + 1 : asked;
  }
  slice_pause();
  return least > most ? -1 : least;
}

/* The w at the other end at which two bounds are met at once. */
static double meeting(enum limits_end end, struct edge one, struct edge other) {
  const struct bound *a = &bounds[one.bound], *b = &bounds[other.bound];
  const int64_t x = one.above ? b->c[end] : -(int64_t)b->c[end], y = other.above ? a->c[end] : -(int64_t)a->c[end];
  const int64_t by = (int64_t)a->c[end] * b->c[1 - end] - (int64_t)b->c[end] * a->c[1 - end];
  slice_pause();
  if (by == 0) return -1.0;
  const double quotient = (double)(y - x) / (double)by;
  slice_pause();
  return math_scale(quotient, BEND_BITS + RATE_BITS);
}

static bool rises(enum limits_end end, const struct room* r) {
  const struct bound* b = &bounds[r->upper.bound];
  return !r->narrowed || b->c[1 - end] == 0 || (b->c[end] > 0) != (b->c[1 - end] > 0);
}

/* What can be reached is concave in the w at the other end, and exists at 0: between a place where it rises and one
 * where it falls, or is not, the bounds that are met at both meet nearer to the largest. */
static int32_t search(enum limits_end end, int32_t other, int32_t most) {
  struct room high = room_of(end, other, most);
  if (high.most >= 0 && rises(end, &high)) return high.most;
  struct room low = room_of(end, 0, most);
  int32_t from = 0, to = other, best = high.most > low.most ? high.most : low.most;
  for (uint32_t i = 0; i < SEARCHES && to - from > (to >> NEAR_ENOUGH) + 1; i++) {
    const struct edge edge = high.most < 0 ? high.lower : high.upper;
    double at =
        meeting(end, high.most < 0 && high.narrowed && edge.bound != high.upper.bound ? high.upper : low.upper, edge);
    slice_pause();
    if (!(at > (double)from) || !(at < (double)to) || (i & 1u) != 0) at = ((double)from + (double)to) / 2.0;
    slice_pause();
    const int32_t w = (int32_t)at;
    if (w <= from || w >= to) break;
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
  inside -= SWEEP_INSIDE;
  const int32_t reach = search(end, other, most);
  inside += SWEEP_INSIDE;
  return reach;
}
