#include "firmware/motion/lookahead_limits.h"

#include "firmware/base/dimensions.h"
#include "firmware/kernel/slice.h"

enum { BOUNDS_A_MOTOR = 6, PAUSE_BOUNDS = 8, SEARCHES = 14 };

#define BOUND_ONE (INT64_C(1) << (RATE_BITS + BEND_BITS))

struct bound {
  int32_t c[2];
};
static struct bound bounds[MOTORS * BOUNDS_A_MOTOR];
static uint32_t count;

void limits_begin(void) { count = 0; }

static int32_t magnitude(int32_t value) { return value < 0 ? -value : value; }

/* With w up to 1 the others hold anyway. */
static void add(int32_t c0, int32_t c1) {
  if (magnitude(c0) + magnitude(c1) < 1 << BEND_BITS) return;
  bounds[count++] = (struct bound){{c0, c1}};
}

void limits_add(const struct limits_motor* m, uint32_t quarters) {
  /* x' in the part's own time, halved: its Bernstein coefficients */
  const int32_t h = (int32_t)quarters, a0 = m->bend[0], a1 = m->bend[1];
  const int32_t n0 = m->pace[0] * 2 / h, n2 = m->pace[1] * 2 / h, n1 = n0 + a0 / 4;
  const int32_t b[3][2] = {{a0 - n0, n0}, {a1 / 2 - n1, a0 / 2 + n1}, {-n2, a1 + n2}};
  add(b[0][0], b[0][1]);
  for (int32_t i = 0; i < 4; i++) {
    const int32_t f0 = (4 - i) * (3 - i), f1 = i * (3 - i) + (i + 1) * (4 - i), f2 = i * (i + 1);
    add((int32_t)(((int64_t)f0 * b[0][0] + (int64_t)f1 * b[1][0] + (int64_t)f2 * b[2][0]) / 16),
        (int32_t)(((int64_t)f0 * b[0][1] + (int64_t)f1 * b[1][1] + (int64_t)f2 * b[2][1]) / 16));
  }
  add(b[2][0], b[2][1]);
  slice_pause();
}

/* What the bounds leave for the w at `end`. */
struct room {
  int64_t least, most;
  bool rises; /* `most` rises with the w at the other end */
};

static void narrow(struct room* r, int64_t given, int32_t by, int32_t other) {
  if (by == 0) {
    if (given > BOUND_ONE || given < -BOUND_ONE) r->most = -1;
    return;
  }
  const int64_t up = by > 0 ? BOUND_ONE - given : BOUND_ONE + given;
  const int64_t down = by > 0 ? -BOUND_ONE - given : given - BOUND_ONE;
  const int32_t size = magnitude(by);
  if (r->most > 0 && (int64_t)size * r->most > up) {
    r->most = up < 0 ? -1 : up / size;
    r->rises = (by > 0) != (other > 0) && other != 0;
  } else if (up < 0) {
    r->most = -1;
  }
  if ((int64_t)size * r->least < down) r->least = (down + size - 1) / size;
}

static struct room room_of(enum limits_end end, int32_t w, int32_t most) {
  struct room r = {0, most, true};
  for (uint32_t i = 0; i < count; i++) {
    const struct bound* b = &bounds[i];
    narrow(&r, (int64_t)b->c[1 - end] * w, b->c[end], b->c[1 - end]);
    if (i % PAUSE_BOUNDS == 0) slice_pause();
  }
  return r;
}

int32_t limits_most(enum limits_end end, int32_t w, int32_t most) {
  const struct room r = room_of(end, w, most);
  return r.most < r.least ? -1 : (int32_t)r.most;
}

int32_t limits_least(enum limits_end end, int32_t w, int32_t most) {
  const struct room r = room_of(end, w, most);
  return r.most < r.least ? -1 : (int32_t)r.least;
}

/* What can be reached is concave in the w at the other end, and 0 goes with 0: halving. */
int32_t limits_reach(enum limits_end end, int32_t other, int32_t most) {
  struct room r = room_of(end, other, most);
  if (r.most >= r.least && (r.rises || r.most == most)) return (int32_t)r.most;
  int64_t best = r.most >= r.least ? r.most : 0;
  int32_t low = 0, high = other;
  for (uint32_t i = 0; i < SEARCHES && high - low > 1; i++) {
    const int32_t middle = i < SEARCHES / 2 && low == 0 ? high / 4 : low + (high - low) / 2;
    r = room_of(end, middle, most);
    const bool possible = r.most >= r.least;
    if (possible && r.most > best) best = r.most;
    if (possible && r.rises)
      low = middle;
    else
      high = middle;
  }
  r = room_of(end, low, most);
  return r.most >= r.least && r.most > best ? (int32_t)r.most : (int32_t)best;
}
