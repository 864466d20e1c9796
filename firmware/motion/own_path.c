#include "firmware/motion/own_path.h"

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/fixed_point.h"

enum { TIME_FRACTION_BITS = 23, STAY_TIME_BITS = 36 }; /* a part of a stay lasts 2^36 units, 8192 ms */

#define STAY_MS 8192.0
#define CARRY_ONE 4294967296.0
#define STANDS_STILL 0.5 /* a speed below this is what the roundings of a cubic have left */

static int64_t nearest(double value) { return math_to_integer(value + 0.5); }

void own_path_begin(struct own_path* path, int64_t start) {
  path->elapsed = path->shift = 0;
  path->executing = path->count = 0;
  path->repeats = path->carry = path->carried = 0;
  path->start = path->end = start;
  path->exact = 0.0;
}

static void set_time(struct own_piece* piece, int64_t time) {
  piece->time = fixed_larger(time, 1);
  piece->shift = __builtin_clzll((uint64_t)piece->time) - 32;
  const double normal = math_scale((double)piece->time, piece->shift - 32); /* [0.5, 1) */
  slice_pause();
  const double of_one = 1.0 / normal;
  slice_pause();
  const int64_t inverse = math_to_integer(math_scale(of_one, 31));
  piece->inverse = inverse > (int64_t)UINT32_MAX ? UINT32_MAX : (uint32_t)inverse;
}

/* No more than one product or division from pause to pause. */
static double paused(double value) {
  slice_pause();
  return value;
}

static uint8_t shape_of(double acceleration, double jerk) {
  if (jerk == 0.0) return acceleration == 0.0 ? SHAPE_STRAIGHT : SHAPE_EVEN;
  return acceleration == 0.0 ? SHAPE_FROM_0 : SHAPE_TO_0;
}

/* From the end so far: speed at its start, acceleration there and the constant change of that. What each end is rounded
 * by does not add up. */
static void add(struct own_path* path, double time, double speed, double acceleration, double jerk) {
  struct own_piece* piece = &path->pieces[path->count++];
  struct cubic* cubic = &piece->cubic;
  slice_pause();
  set_time(piece, nearest(math_scale(time, TIME_FRACTION_BITS)));
  piece->speed = speed;
  piece->shape = shape_of(acceleration, jerk);
  slice_pause();
  const double linear = speed * time;
  const double square = paused(paused(acceleration * time) * time) / 2.0;
  const double cube = paused(paused(paused(jerk * time) * time) * time) / 6.0;
  slice_pause();
  path->exact += linear + square + cube;
  slice_pause();
  const int64_t end = path->start + nearest(path->exact);
  cubic->start = path->end;
  slice_pause();
  cubic->square = nearest(square);
  cubic->cube = nearest(cube);
  slice_pause();
  cubic->linear = end - cubic->start - cubic->square - cubic->cube;
  path->end = end;
}

/* What only an S-curve needs stands behind its test: the compiler puts it there, pauses or not. */
void own_path_change(struct own_path* path, const struct speed_limits* l, double from, double to) {
  const double time = speed_change_time(l, from, to), s = l->s_curve;
  if (time <= 0.0) return;
  slice_pause();
  const double change = to - from, lasts = time - s;
  slice_pause();
  const double acceleration = change / lasts;
  slice_pause();
  if (!(s > 0.0)) {
    add(path, time, from, acceleration, 0.0);
    return;
  }
  const double level = time - 2.0 * s;
  slice_pause();
  const double gained = paused(acceleration * s) / 2.0;
  slice_pause();
  const double jerk = acceleration / s;
  add(path, s, from, 0.0, jerk);
  if (level > 0.0) add(path, level, from + gained, acceleration, 0.0);
  add(path, s, to - gained, acceleration, -jerk);
}

void own_path_ramp(struct own_path* path, double from, double time) {
  if (time > 0.0) add(path, time, from, -from / time, 0.0);
}

/* One part of a stay of many. */
static void add_repeated(struct own_path* path, double speed, uint32_t repeats) {
  path->repeated = path->count++;
  path->repeats = repeats;
  struct own_piece* piece = &path->pieces[path->repeated];
  slice_pause();
  const double distance = speed * STAY_MS;
  set_time(piece, INT64_C(1) << STAY_TIME_BITS);
  piece->speed = speed;
  piece->shape = SHAPE_STRAIGHT;
  slice_pause();
  piece->cubic = (struct cubic){.start = path->end, .linear = math_to_integer(distance)};
  path->carry = (uint32_t)math_to_integer((distance - (double)piece->cubic.linear) * CARRY_ONE);
}

void own_path_stay(struct own_path* path, double speed, double time) {
  if (!(time > 0.0)) return;
  const uint32_t whole = (uint32_t)math_to_integer(time / STAY_MS);
  if (whole > 0u) {
    add_repeated(path, speed, whole - 1u);
    const struct cubic* cubic = &path->pieces[path->repeated].cubic;
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
  if (path->count == 0u) return;
  path->pieces[path->count - 1u].cubic.linear += end - path->end;
  path->end = end;
}

/* The piece under way once more. */
static void repeat(struct own_path* path) {
  struct own_piece* piece = &path->pieces[path->repeated];
  const uint64_t carried = (uint64_t)path->carried + path->carry;
  path->carried = (uint32_t)carried;
  piece->cubic.start += piece->cubic.linear + (int64_t)(carried >> 32);
  path->elapsed -= piece->time;
  if (path->repeats != OWN_PATH_ENDLESS) path->repeats--;
}

/* Of the time, below which `elapsed` is: neither is rounded so much that it came to 1. */
static inline uint32_t fraction_of(const struct own_piece* piece, int64_t elapsed) {
  const uint32_t part = (uint32_t)(piece->shift < 0 ? elapsed >> -piece->shift : elapsed << piece->shift);
  return (uint32_t)((uint64_t)part * piece->inverse >> 31);
}

static inline int64_t position_in(const struct own_path* path, const struct own_piece* piece, int64_t elapsed) {
  const uint32_t fraction = fraction_of(piece, elapsed);
  const struct cubic* cubic = &piece->cubic;
  const int64_t at =
      piece->shape == SHAPE_STRAIGHT ? cubic->start + fixed_part(cubic->linear, fraction) : cubic_at(cubic, fraction);
  return at + path->shift;
}

static __attribute__((noinline)) bool into_next(struct own_path* path, int64_t* position) {
  while (path->executing != path->count) {
    const struct own_piece* piece = &path->pieces[path->executing];
    const int64_t time = piece->time;
    if (path->elapsed < time) {
      *position = position_in(path, piece, path->elapsed);
      return true;
    }
    if (path->repeats != 0u && path->executing == path->repeated) {
      repeat(path);
    } else {
      path->elapsed -= time;
      path->executing++;
    }
  }
  *position = path->end + path->shift;
  return false;
}

/* The call is the last thing, so that what does not need it saves no registers. */
bool own_path_advance(struct own_path* path, int32_t increment, int64_t* position) {
  const struct own_piece* piece = &path->pieces[path->executing];
  FIXED_IN_REGISTER(piece);
  const int64_t elapsed = path->elapsed + increment;
  path->elapsed = elapsed;
  if (path->executing == path->count || elapsed >= piece->time) return into_next(path, position);
  *position = position_in(path, piece, elapsed);
  return true;
}

void own_path_stands(struct own_path_place* place, int64_t position) {
  *place = (struct own_path_place){.cubic.start = position, .time = 1, .elapsed = 1, .to = PIECE_PARTS};
}

/* The stay, `elapsed` after its present part began. False: it is over by then. */
static bool stays(const struct own_path* path, int64_t* elapsed) {
  const int64_t parts = *elapsed >> STAY_TIME_BITS;
  if (path->repeats != OWN_PATH_ENDLESS && parts > (int64_t)path->repeats) {
    *elapsed -= ((int64_t)path->repeats + 1) << STAY_TIME_BITS;
    return false;
  }
  return true;
}

static void lies_in(struct own_path_place* place, const struct own_path* path, uint32_t number, int64_t elapsed) {
  const struct own_piece* piece = &path->pieces[number];
  place->cubic = piece->cubic;
  place->cubic.start += path->shift;
  place->time = piece->time;
  place->elapsed = elapsed;
  place->warp = 0;
  place->from = 0;
  place->to = PIECE_PARTS;
  place->shape = piece->shape;
  place->speed = piece->speed;
  place->then = number + 1u != path->count ? piece[1].speed : 0.0;
}

void own_path_place(struct own_path_place* place, const struct own_path* path, int64_t ahead) {
  int64_t elapsed = path->elapsed + ahead;
  for (uint32_t number = path->executing; number != path->count; number++) {
    if (path->repeats != 0u && number == path->repeated) {
      if (!stays(path, &elapsed)) continue;
      const int64_t parts = elapsed >> STAY_TIME_BITS;
      lies_in(place, path, number, elapsed - (parts << STAY_TIME_BITS));
      const uint64_t carried = path->carried + (uint64_t)path->carry * (uint64_t)parts;
      place->cubic.start += place->cubic.linear * parts + (int64_t)(carried >> 32);
      return;
    }
    if (elapsed < path->pieces[number].time) {
      lies_in(place, path, number, elapsed);
      return;
    }
    elapsed -= path->pieces[number].time;
  }
  own_path_stands(place, path->end + path->shift);
}

/* The part of its cubic that is made after a part of the time of a piece, and how fast that grows with it. */
static double part_of_way(const struct own_path_place* place, double part, double* rate) {
  *rate = 1.0;
  if (place->warp != 0) {
    const double warp = (double)place->warp / (double)PIECE_WARP_ONE;
    slice_pause();
    const double left = 1.0 - part, bulge = warp * part;
    slice_pause();
    *rate += warp * left - bulge;
    slice_pause();
    part += bulge * left;
  }
  if (place->from == 0 && place->to == PIECE_PARTS) return part;
  const double share = (double)(place->to - place->from) / (double)PIECE_PARTS;
  slice_pause();
  *rate *= share;
  part *= share;
  return (double)place->from / (double)PIECE_PARTS + part;
}

/* After a part of its time. Not of the cubic: what the roundings of a short one make of its speed would be counts at
 * the end of a long change that begins there. */
static double exact_speed(const struct own_path_place* place, double part) {
  double share = part;
  if (place->shape == SHAPE_STRAIGHT) return place->speed; /* also without an end */
  if (place->shape == SHAPE_FROM_0) share = part * part;
  if (place->shape == SHAPE_TO_0) share = part * (2.0 - part);
  slice_pause();
  const double gained = (place->then - place->speed) * share;
  slice_pause();
  return place->speed + gained;
}

static double speed_of_cubic(const struct own_path_place* place, double part, double rate) {
  const struct cubic* c = &place->cubic;
  const double square = (double)c->square, cube = (double)c->cube;
  slice_pause();
  const double of_cube = part * 3.0 * cube;
  slice_pause();
  const double both = 2.0 * square + of_cube;
  const double turn = part * both;
  slice_pause();
  const double slope = rate * ((double)c->linear + turn);
  slice_pause();
  const double time = math_scale((double)place->time, -TIME_FRACTION_BITS);
  slice_pause();
  const double speed = slope / time;
  return math_absolute(speed) < STANDS_STILL ? 0.0 : speed;
}

struct own_path_state own_path_state(const struct own_path_place* place) {
  const struct cubic* c = &place->cubic;
  double rate;
  if (place->elapsed >= place->time) return (struct own_path_state){(double)cubic_end(c), 0.0};
  slice_pause();
  const double begun = (double)place->elapsed / (double)place->time;
  slice_pause();
  const double part = part_of_way(place, begun, &rate);
  slice_pause();
  const double square = (double)c->square, cube = (double)c->cube;
  const double steep = square + part * cube;
  slice_pause();
  const double bend = part * steep;
  slice_pause();
  const double moved = part * ((double)c->linear + bend);
  slice_pause();
  const bool exact = place->shape != SHAPE_OF_CUBIC;
  const double speed = exact ? exact_speed(place, part) : speed_of_cubic(place, part, rate);
  slice_pause();
  return (struct own_path_state){(double)c->start + moved, speed};
}
