#include "firmware/motion/own_path.h"

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"

enum { TIME_FRACTION_BITS = 23, STAY_TIME_BITS = 36 }; /* a part of a stay lasts 2^36 units, 8192 ms */

#define STAY_MS 8192.0
#define CARRY_ONE 4294967296.0

static int64_t nearest(double value) { return math_to_integer(value + 0.5); }

void own_path_begin(struct own_path* path, int64_t start) {
  piece_ring_initialize(&path->ring, path->cubics, 1);
  path->repeats = path->carry = path->carried = 0;
  path->start = path->end = start;
  path->shift = 0;
  path->exact = 0.0;
}

/* From the end so far: speed at its start, acceleration there and the constant change of that. What each end is rounded
 * by does not add up. */
static void add(struct own_path* path, double time, double speed, double acceleration, double jerk) {
  const uint32_t number = path->ring.added;
  struct piece* piece = piece_ring_at(&path->ring, number);
  struct cubic* cubic = piece_ring_cubic(&path->ring, number, 0);
  slice_pause();
  piece_set_time(piece, nearest(math_scale(time, TIME_FRACTION_BITS)));
  piece->motors = 1;
  slice_pause();
  const double linear = speed * time, square = acceleration * time * time / 2.0;
  slice_pause();
  const double cube = jerk * time * time * time / 6.0;
  path->exact += linear + square + cube;
  slice_pause();
  const int64_t end = path->start + nearest(path->exact);
  cubic->start = path->end;
  cubic->linear = nearest(linear);
  cubic->square = nearest(square);
  cubic->cube = end - cubic->start - cubic->linear - cubic->square;
  path->end = end;
  piece_ring_add(&path->ring);
}

void own_path_change(struct own_path* path, const struct speed_limits* l, double from, double to) {
  const double time = speed_change_time(l, from, to), s = l->s_curve, level = time - 2.0 * s;
  if (time <= 0.0) return;
  slice_pause();
  const double acceleration = (to - from) / (time - s), gained = acceleration * s / 2.0;
  slice_pause();
  if (s > 0.0) {
    const double jerk = acceleration / s;
    add(path, s, from, 0.0, jerk);
    if (level > 0.0) add(path, level, from + gained, acceleration, 0.0);
    add(path, s, to - gained, acceleration, -jerk);
  } else {
    add(path, time, from, acceleration, 0.0);
  }
}

void own_path_ramp(struct own_path* path, double from, double time) {
  if (time > 0.0) add(path, time, from, -from / time, 0.0);
}

/* One part of a stay of many. */
static void add_repeated(struct own_path* path, double speed, uint32_t repeats) {
  const uint32_t number = path->ring.added;
  struct piece* piece = piece_ring_at(&path->ring, number);
  struct cubic* cubic = piece_ring_cubic(&path->ring, number, 0);
  slice_pause();
  const double distance = speed * STAY_MS;
  piece_set_time(piece, INT64_C(1) << STAY_TIME_BITS);
  piece->motors = 1;
  slice_pause();
  *cubic = (struct cubic){.start = path->end, .linear = math_to_integer(distance)};
  path->carry = (uint32_t)math_to_integer((distance - (double)cubic->linear) * CARRY_ONE);
  path->repeated = number;
  path->repeats = repeats;
  piece_ring_add(&path->ring);
}

void own_path_stay(struct own_path* path, double speed, double time) {
  if (!(time > 0.0)) return;
  slice_pause();
  const uint32_t whole = (uint32_t)math_to_integer(time / STAY_MS);
  if (whole > 0u) {
    add_repeated(path, speed, whole - 1u);
    const struct cubic* cubic = piece_ring_cubic(&path->ring, path->repeated, 0);
    path->end += cubic->linear * (int64_t)whole + (int64_t)(((uint64_t)path->carry * whole) >> 32);
    slice_pause();
    path->exact += speed * STAY_MS * (double)whole;
  }
  slice_pause();
  const double rest = time - STAY_MS * (double)whole;
  if (rest > 0.0) add(path, rest, speed, 0.0, 0.0);
}

void own_path_stay_for_ever(struct own_path* path, double speed) { add_repeated(path, speed, OWN_PATH_ENDLESS); }

void own_path_end_at(struct own_path* path, int64_t end) {
  if (piece_ring_is_empty(&path->ring)) return;
  piece_ring_cubic(&path->ring, path->ring.added - 1u, 0)->cube += end - path->end;
  path->end = end;
}

static void repeat(struct own_path* path, int64_t increment) {
  struct piece_ring* ring = &path->ring;
  const int64_t time = piece_ring_at(ring, path->repeated)->time;
  if (ring->elapsed + increment < time) return;
  struct cubic* cubic = piece_ring_cubic(ring, path->repeated, 0);
  const uint64_t carried = (uint64_t)path->carried + path->carry;
  path->carried = (uint32_t)carried;
  cubic->start += cubic->linear + (int64_t)(carried >> 32);
  ring->elapsed -= time; /* below 0 until it is advanced */
  if (path->repeats != OWN_PATH_ENDLESS) path->repeats--;
}

bool own_path_advance(struct own_path* path, int64_t increment) {
  if (path->repeats != 0u && path->ring.executing == path->repeated) repeat(path, increment);
  return piece_ring_advance(&path->ring, increment);
}

int64_t own_path_position(const struct own_path* path) {
  const struct piece_ring* ring = &path->ring;
  if (piece_ring_is_empty(ring)) return path->end + path->shift;
  return cubic_at(&path->cubics[ring->executing % PIECES], ring->fraction) + path->shift;
}

/* The stay, `elapsed` after its present part began. False: it is over by then. */
static bool stays(const struct own_path* path, int64_t* elapsed, struct own_path_place* place) {
  const int64_t parts = *elapsed >> STAY_TIME_BITS;
  if (path->repeats != OWN_PATH_ENDLESS && parts > (int64_t)path->repeats) {
    *elapsed -= ((int64_t)path->repeats + 1) << STAY_TIME_BITS;
    return false;
  }
  place->cubic = path->cubics[path->repeated % PIECES];
  place->cubic.start += place->cubic.linear * parts;
  place->time = INT64_C(1) << STAY_TIME_BITS;
  place->elapsed = *elapsed - (parts << STAY_TIME_BITS);
  return true;
}

struct own_path_place own_path_stands(int64_t position) {
  return (struct own_path_place){.cubic.start = position, .time = 1, .elapsed = 1};
}

static struct own_path_place find(const struct own_path* path, int64_t ahead) {
  const struct piece_ring* ring = &path->ring;
  struct own_path_place place = own_path_stands(path->end);
  int64_t elapsed = ring->elapsed + ahead;
  for (uint32_t number = ring->executing; number != ring->added; number++) {
    if (path->repeats != 0u && number == path->repeated) {
      if (stays(path, &elapsed, &place)) return place;
      continue;
    }
    const int64_t time = ring->pieces[number % PIECES].time;
    if (elapsed < time) return (struct own_path_place){path->cubics[number % PIECES], time, elapsed};
    elapsed -= time;
  }
  return place;
}

struct own_path_place own_path_place(const struct own_path* path, int64_t ahead) {
  struct own_path_place place = find(path, ahead);
  place.cubic.start += path->shift;
  return place;
}

struct own_path_state own_path_state(const struct own_path_place* place) {
  const struct cubic* c = &place->cubic;
  if (place->elapsed >= place->time) return (struct own_path_state){(double)cubic_end(c), 0.0};
  slice_pause();
  const double time = (double)place->time, part = (double)place->elapsed / time;
  slice_pause();
  const double square = (double)c->square, cube = (double)c->cube;
  const double moved = part * ((double)c->linear + part * (square + part * cube));
  slice_pause();
  const double slope = (double)c->linear + part * (2.0 * square + part * 3.0 * cube);
  slice_pause();
  return (struct own_path_state){(double)c->start + moved, slope / math_scale(time, -TIME_FRACTION_BITS)};
}
