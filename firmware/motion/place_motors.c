/* A move of motors becomes pieces: the change of velocity at its first corner, a straight part, and the change to rest
 * at its end. They are made behind what the servo task has, in slices, and then handed over in a few instructions. All
 * sums are made in doubles from corner to corner and rounded where a piece ends, so nothing adds up. */
#include "firmware/motion/place_motors.h"

#include "firmware/base/mathematics.h"
#include "firmware/hal/hal.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/spline_motor.h"
#include "firmware/motion/system_motors.h"
#include "firmware/motion/velocity_change.h"

enum {
  ATTEMPTS = 4,     /* to blend while the executing move goes on */
  FIRST_MARGIN = 4, /* servo interrupts that the first may take; each one more four times as many */
  MOST_PIECES = 8   /* of a move: what lengthens the one before, two changes, the straight part */
};

/* A move that is being placed. One at a time: there is one planner. */
static struct {
  struct coordinate_system* s;
  const struct motor_move *before, *after; /* `before` null: from rest */
  uint32_t added;                          /* pieces so far, behind those of the ring */
  int64_t reached[MOTORS];                 /* where they end */
} making;

static double milliseconds(int64_t time) { return math_scale((double)time, -TRAJECTORY_FRACTION_BITS); }

static struct piece* begin_piece(int64_t time, uint32_t motors_in_it, uint32_t move) {
  struct piece* piece = piece_ring_at(&making.s->ring, making.s->ring.added + making.added++);
  piece_set_time(piece, time);
  piece->motors = motors_in_it;
  piece->move = move;
  slice_pause();
  return piece;
}

static struct cubic* cubic_of(uint32_t motor) {
  return piece_ring_cubic(&making.s->ring, making.s->ring.added + making.added - 1u, motor);
}

/* The motor's part of the piece that was begun last, to the position `end`. */
static void add_cubic(uint32_t motor, double end, double square, double cube) {
  struct cubic* c = cubic_of(motor);
  const int64_t to = math_nearest(end);
  c->start = making.reached[motor];
  slice_pause();
  c->square = square == 0.0 ? 0 : math_nearest(square);
  c->cube = cube == 0.0 ? 0 : math_nearest(cube);
  c->linear = to - c->start - c->square - c->cube;
  making.reached[motor] = to;
  slice_pause();
}

static uint32_t moving(const struct motor_move* moves) {
  uint32_t mask = 0;
  if (moves == 0) return 0;
  for (uint32_t motor = 0, left = making.s->motors; left != 0; motor++, left >>= 1)
    if ((left & 1u) != 0 && moves[motor].velocity != 0.0) mask |= 1u << motor;
  return mask;
}

/* From the velocity of `before` to that of `after` about the corner between them; null: rest. */
static void add_change(const struct motor_move* before, const struct motor_move* after, int64_t length, int64_t s_curve,
                       uint32_t move) {
  struct velocity_part parts[VELOCITY_PARTS];
  static double corner[MOTORS], first[MOTORS], change[MOTORS];
  const uint32_t mask = moving(before) | moving(after), count = velocity_change(length, s_curve, parts);
  const double time = milliseconds(length);
  for (uint32_t motor = 0, left = mask; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    corner[motor] = after != 0 ? after[motor].from : before[motor].to;
    first[motor] = before == 0 ? 0.0 : before[motor].velocity * time;
    slice_pause();
    change[motor] = (after == 0 ? 0.0 : after[motor].velocity * time) - first[motor];
  }
  for (uint32_t i = 0; i < count; i++) {
    begin_piece(parts[i].time, mask, move);
    for (uint32_t motor = 0, left = mask; left != 0; motor++, left >>= 1) {
      if ((left & 1u) == 0) continue;
      double end = corner[motor];
      const bool is_stop = after == 0 && i + 1u == count; /* exact */
      if (!is_stop) end += first[motor] * (parts[i].at - 0.5) + change[motor] * parts[i].risen;
      slice_pause();
      add_cubic(motor, end, change[motor] * parts[i].square, change[motor] * parts[i].cube);
    }
  }
}

/* At the velocity of `m`, to `left_over` before the corner at its end. */
static void add_straight(const struct motor_move* m, int64_t time, int64_t left_over, uint32_t move) {
  const uint32_t mask = moving(m);
  const double rest = milliseconds(left_over);
  if (time <= 0) { /* there is one to be cut short in any case */
    begin_piece(1, 0, move)->end = 0;
    return;
  }
  begin_piece(time, mask, move);
  for (uint32_t motor = 0, left = mask; left != 0; motor++, left >>= 1)
    if ((left & 1u) != 0) add_cubic(motor, m[motor].to - m[motor].velocity * rest, 0.0, 0.0);
}

/* Where they are `ahead` of a corner, that at the end of `before`; from rest: at their first one. */
static void begin_at(const struct motor_move* before, int64_t ahead) {
  const double time = milliseconds(ahead);
  for (uint32_t motor = 0, left = making.s->motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    const double at = before == 0 ? making.after[motor].from : before[motor].to - before[motor].velocity * time;
    slice_pause();
    making.reached[motor] = math_nearest(at);
    slice_pause();
  }
}

/* How the executing move goes over to the next: when it is left, and the length of the change. */
struct joint {
  int64_t end, stop_begin, half; /* times of the executing move */
};

/* Longest |v1 - v0| / Ixx17 of the motors, in trajectory time. */
static double change_needs(void) {
  double longest = 0.0;
  for (uint32_t motor = 0, left = making.s->motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    const double change = math_absolute(making.after[motor].velocity - making.before[motor].velocity);
    slice_pause();
    const double most = change == 0.0 ? 0.0 : system_motor_acceleration(motor);
    if (most == 0.0) continue;
    const double time = change / most;
    slice_pause();
    if (time > longest) longest = time;
  }
  return math_scale(longest, TRAJECTORY_FRACTION_BITS);
}

/* S-curves keep their share of a change that is shorter than it should be. */
static int64_t s_part(const struct move* next, int64_t length) {
  if (length >= next->acceleration) return next->s_curve;
  const double part = (double)next->s_curve * (double)length / (double)next->acceleration;
  return (int64_t)part;
}

/* False: there is no time for a blend within the limits. */
static bool find_joint(const struct move* next, double needed, int64_t margin, struct joint* j) {
  const struct coordinate_system* s = making.s;
  const struct move* m = &s->moves[s->executing];
  const uint32_t state = hal_mask_servo();
  const int64_t now = s->elapsed + margin;
  const bool active = s->active;
  hal_unmask(state);
  const int64_t corner = m->blend_in / 2 + m->time;
  j->stop_begin = corner - m->stop_length / 2;
  if (!active || now >= j->stop_begin) return false;
  j->half = ((int64_t)needed + next->s_curve + 2) / 2;
  j->half = fixed_larger(j->half, next->acceleration / 2);
  const int64_t before = m->time - m->blend_in / 2, behind = next->time - next->stop_length / 2;
  j->half = fixed_smaller(fixed_smaller(j->half, before), fixed_smaller(behind, corner - now));
  j->end = corner - j->half;
  return needed == 0.0 || (double)(2 * j->half - s_part(next, 2 * j->half)) >= needed;
}

/* Behind the change at its beginning. */
static void add_rest(struct move* next, uint32_t number) {
  next->straight_begin = next->blend_in;
  add_straight(making.after, next->blend_in / 2 + next->time - next->stop_length / 2 - next->blend_in,
               next->stop_length / 2, number);
  add_change(making.after, 0, next->stop_length, next->s_curve, number);
}

/* The executing move is over too early for it: false. */
static bool hand_over(const struct move* m, struct move* next, const struct joint* j) {
  struct coordinate_system* s = making.s;
  const int64_t end = (j->end < j->stop_begin ? j->end : j->stop_begin) - m->straight_begin;
  const uint32_t state = hal_mask_servo();
  const bool in_time = piece_ring_replace(&s->ring, m->straight, end, making.added);
  if (in_time) {
    next->blended = true;
    s->placed = true;
  }
  hal_unmask(state);
  return in_time;
}

static bool blend(struct move* next, uint32_t number) {
  struct coordinate_system* s = making.s;
  const struct move* m = &s->moves[s->executing];
  int64_t margin = (int64_t)FIRST_MARGIN * s->increment;
  making.before = motor_moves[s->executing];
  const double needed = change_needs();
  for (uint32_t attempt = 0; attempt < ATTEMPTS; attempt++, margin *= 4) {
    struct joint j;
    if (!find_joint(next, needed, margin, &j)) return false;
    making.added = 0;
    if (j.end > j.stop_begin) {
      begin_at(making.before, m->stop_length / 2);
      add_straight(making.before, j.end - j.stop_begin, j.half, s->started);
    } else {
      begin_at(making.before, j.half);
    }
    next->blend_in = 2 * j.half;
    add_change(making.before, making.after, next->blend_in, s_part(next, next->blend_in), number);
    next->straight = s->ring.added + making.added;
    add_rest(next, number);
    if (hand_over(m, next, &j)) return true;
  }
  return false;
}

/* Behind the last piece. */
static void append(struct coordinate_system* s) {
  const uint32_t state = hal_mask_servo();
  for (uint32_t i = 0; i < making.added; i++) piece_ring_add(&s->ring);
  s->placed = true;
  hal_unmask(state);
}

static void from_rest(struct move* next, uint32_t number) {
  struct coordinate_system* s = making.s;
  making.before = 0;
  making.added = 0;
  begin_at(0, 0);
  next->blended = false;
  next->blend_in = next->stop_length;
  if (next->kind == MOVE_LINEAR) {
    add_change(0, making.after, next->blend_in, next->s_curve, number);
    next->straight = s->ring.added + making.added;
    add_rest(next, number);
  } else { /* time passes, or motors go for themselves */
    next->straight = s->ring.added;
    begin_piece(next->time, 0, number);
  }
  append(s);
}

/* Where the motors are at the knots before and behind a cubic, and their velocities a ms. */
static struct knot_of_motors { double at[MOTORS], velocity[MOTORS]; } ends[2];

/* What goes on at its last velocity does so motor by motor: there may be no place for the axes any more. */
static void run_on(const struct knot_of_motors* before, struct knot_of_motors* found, double time) {
  for (uint32_t motor = 0, left = making.s->inverse_motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    found->at[motor] = before->at[motor] + before->velocity[motor] * time;
    found->velocity[motor] = before->velocity[motor];
    slice_pause();
  }
}

/* From rest motors are where the last solution has them: an inverse program that is asked anew could find another. */
static void find_knot(uint32_t cs, const struct move* next, uint32_t i, bool continues) {
  const struct coordinate_system* s = making.s;
  const struct knot* knot = &next->knots[i];
  struct knot_of_motors* found = &ends[i & 1u];
  const bool rests = i == 0 && !continues, runs_on = next->overruns && i == 2u;
  if (rests)
    system_motors_solve(cs, knot->position);
  else if (!runs_on)
    system_motors_solve_knot(cs, knot);
  for (uint32_t motor = 0, left = s->motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    found->at[motor] = i == 0 ? system_motor_from(motor, knot->position) : system_motor_at(motor, knot->position);
    found->velocity[motor] = rests ? 0.0 : system_motor_velocity_at(motor, knot->velocity);
  }
  if (runs_on) run_on(&ends[1], found, milliseconds(next->knot_time[1]));
}

/* With the way D from where it is: v0 T u + (3 D - (2 v0 + v1) T) u^2 + ((v0 + v1) T - 2 D) u^3. */
static void add_knots(uint32_t motor, uint32_t i, double time) {
  const struct knot_of_motors *first = &ends[i & 1u], *second = &ends[(i + 1u) & 1u];
  const double to = second->at[motor], way = to - first->at[motor];
  const double v0 = first->velocity[motor] * time;
  const double v1 = second->velocity[motor] * time;
  slice_pause();
  add_cubic(motor, to, 3.0 * way - v0 - v0 - v1, v0 + v1 - way - way);
}

/* In place of what ends the sequence, whose first cubic is the executing move; else behind all there is. False: it has
 * ended meanwhile, or there is no solution. */
static bool go_on(struct move* next, bool continues) {
  struct coordinate_system* s = making.s;
  const struct move* m = &s->moves[s->executing];
  if (s->failure != RUN_TIME_NONE) return false;
  next->blended = continues;
  if (!continues) {
    append(s);
    return true;
  }
  const uint32_t state = hal_mask_servo();
  s->placed = piece_ring_replace(&s->ring, m->straight, m->knot_time[0], making.added);
  hal_unmask(state);
  return s->placed;
}

static bool place_pvt(uint32_t cs, struct move* next, uint32_t number) {
  struct coordinate_system* s = making.s;
  const bool continues = move_continues(s);
  making.added = 0;
  find_knot(cs, next, 0, continues);
  for (uint32_t motor = 0, left = s->motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    making.reached[motor] = math_nearest(ends[0].at[motor]);
    slice_pause();
  }
  next->straight = s->ring.added;
  for (uint32_t i = 0; i + 1u < next->knot_count; i++) {
    find_knot(cs, next, i + 1u, continues);
    begin_piece(next->knot_time[i], s->motors, number);
    for (uint32_t motor = 0, left = s->motors; left != 0; motor++, left >>= 1)
      if ((left & 1u) != 0) add_knots(motor, i, milliseconds(next->knot_time[i]));
  }
  return go_on(next, continues);
}

/* As coordinate_system.moves. */
static struct spline_motor splines[2][MOTORS];

/* The time of the point before, in that of both, 2^-32. */
static uint32_t share_of(int64_t first, int64_t second) {
  if (first == second) return UINT32_C(1) << 31;
  const double both = (double)(first + second);
  return (uint32_t)math_to_integer(math_scale((double)first / both, 32));
}

/* Where motors have come to: the way to the first point takes along what stands beside their axes. */
static void begin_splines(uint32_t cs, const struct move* next, struct spline_motor begun[MOTORS]) {
  system_motors_solve(cs, next->start);
  for (uint32_t motor = 0, left = making.s->motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    const int64_t from = math_nearest(system_motor_from(motor, next->start));
    begun[motor] = (struct spline_motor){.point = from, .knot = from};
  }
}

static bool place_spline(uint32_t cs, struct move* next, uint32_t index, uint32_t number) {
  struct coordinate_system* s = making.s;
  const bool continues = move_continues(s);
  struct spline_motor* before = splines[index ^ 1u];
  next->knot_time[0] = continues ? s->moves[index ^ 1u].time : next->time;
  const uint32_t share = share_of(next->knot_time[0], next->time);
  making.added = 0;
  next->straight = s->ring.added;
  for (uint32_t i = 0; i < SPLINE_PIECES; i++) begin_piece(i == 0 ? next->knot_time[0] : next->time, s->motors, number);
  if (!continues) begin_splines(cs, next, before);
  system_motors_solve(cs, s->position);
  for (uint32_t motor = 0, left = s->motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    struct cubic cubics[SPLINE_PIECES];
    const int64_t point = math_nearest(system_motor_at(motor, s->position));
    splines[index][motor] = spline_motor_point(&before[motor], point, share, cubics);
    for (uint32_t i = 0; i < SPLINE_PIECES; i++) *piece_ring_cubic(&s->ring, next->straight + i, motor) = cubics[i];
  }
  return go_on(next, continues);
}

bool move_place_motors(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  const uint32_t index = s->executing ^ 1u, number = s->planned;
  struct move* next = &s->moves[index];
  if (piece_ring_room(&s->ring) < MOST_PIECES) return false;
  making.s = s;
  making.after = motor_moves[index];
  if (next->kind == MOVE_PVT) return place_pvt(cs, next, number);
  if (next->kind == MOVE_SPLINE) return place_spline(cs, next, index, number);
  if (next->kind == MOVE_LINEAR && move_continues(s) && blend(next, number)) return true;
  from_rest(next, number);
  return true;
}
