#include "firmware/motion/place.h"

#include "firmware/hal/hal.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/corner.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/path.h"
#include "firmware/motion/place_motors.h"
#include "firmware/motion/plan_cubic.h"
#include "firmware/motion/plan_own.h"
#include "firmware/motion/segment.h"
#include "firmware/motion/system_motors.h"

static int64_t corner(const struct move* m) { return m->blend_in / 2 + m->time; }

/* Nobody asks where in it the axes are: it has its time alone. What divides by that time stays as it was. */
static void add_time(struct piece_ring* ring, int64_t time, uint32_t move) {
  struct piece* piece = piece_ring_at(ring, ring->added);
  piece->time = piece->end = time;
  piece->move = move;
  piece->motors = 0;
  piece->warp = 0;
  piece->from = piece->to = 0;
  piece->continues = false;
  piece_ring_add(ring);
}

/* The executing move goes on at its velocity until `end`. */
static void go_straight(struct coordinate_system* s, int64_t stop_begin, int64_t end) {
  struct move* m = &s->moves[s->executing];
  struct piece* straight = piece_ring_at(&s->ring, m->straight);
  piece_ring_take_back(&s->ring, m->straight + 1u);
  straight->time = straight->end = (end < stop_begin ? end : stop_begin) - m->straight_begin;
  if (end <= stop_begin) return;
  m->straight = s->ring.added;
  m->straight_begin = stop_begin;
  add_time(&s->ring, end - stop_begin, s->started);
}

/* A blend that should have begun earlier is shortened; it cannot begin before the move's own has ended. */
static bool blend(struct coordinate_system* s, struct move* next) {
  const struct move* m = &s->moves[s->executing];
  const int64_t end = corner(m), stop_begin = end - m->stop_length / 2, longest = m->time - m->blend_in / 2;
  if (!move_continues(s) || s->elapsed >= stop_begin) return false;
  int64_t half = next->acceleration / 2;
  half = fixed_smaller(fixed_smaller(half, longest), end - s->elapsed);
  go_straight(s, stop_begin, end - half);
  next->blend_in = 2 * half;
  return true;
}

/* PVT, SPLINE: behind the first cubic of the move that it goes on with. False: that is over. */
static bool goes_on(struct coordinate_system* s, const struct move* next) {
  const uint32_t straight = s->moves[s->executing].straight;
  if (!s->active || (int32_t)(straight - s->ring.executing) < 0) return false;
  if (next->joins) piece_ring_take_back(&s->ring, straight + 1u);
  return true;
}

static void place_cubic(struct coordinate_system* s, struct move* next) {
  next->blended = move_continues(s) && goes_on(s, next);
  next->straight = s->ring.added;
  next->straight_begin = 0;
  for (uint32_t i = 0; i + 1u < next->knot_count; i++) add_time(&s->ring, next->knot_time[i], s->started + 1u);
}

static void place_linear(struct coordinate_system* s, struct move* next) {
  const uint32_t number = s->started + 1u;
  next->blended = blend(s, next);
  if (!next->blended) next->blend_in = next->acceleration;
  next->stop_length = next->acceleration;
  next->straight_begin = next->blend_in;
  add_time(&s->ring, next->blend_in, number);
  next->straight = s->ring.added;
  add_time(&s->ring, corner(next) - next->stop_length / 2 - next->blend_in, number);
  add_time(&s->ring, next->stop_length, number);
}

static void place_virtual(struct coordinate_system* s) {
  struct move* next = &s->moves[s->executing ^ 1u];
  if (next->kind == MOVE_LINEAR) {
    place_linear(s, next);
  } else if (next->kind == MOVE_PVT || next->kind == MOVE_SPLINE) {
    place_cubic(s, next);
  } else {
    next->blended = false;
    next->straight = s->ring.added;
    add_time(&s->ring, next->time, s->started + 1u);
  }
  s->placed = true;
}

/* A sequence of SPLINE moves has come to its end meanwhile. */
static bool is_late(const struct coordinate_system* s) {
  const struct move *m = &s->moves[s->executing], *next = &s->moves[s->executing ^ 1u];
  if (next->kind != MOVE_SPLINE || !next->joins) return false;
  return !move_continues(s) || (int32_t)(m->straight - s->ring.executing) < 0;
}

/* A point that was waited for begins a new sequence; one that took too long to calculate is an error. */
static bool begins_anew(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  if (!s->moves[s->executing ^ 1u].waited) {
    s->failure = RUN_TIME_LATE;
    return false;
  }
  plan_spline_anew(cs);
  return true;
}

/* What motors do on their own begins when the path has ended. */
static bool begins_alone(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  if (s->moves[s->executing ^ 1u].kind != MOVE_OWN) return true;
  if (s->active || !piece_ring_is_empty(&s->ring)) return false;
  plan_own_begin(cs);
  return true;
}

bool move_place(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  if (segment_is_under_way(cs)) return false;
  if (!s->next_valid || s->placed || s->end_block || corner_waits(cs) || !begins_alone(cs)) return false;
  if (is_late(s)) return begins_anew(cs); /* placed next time */
  if (s->motors != 0) {
    const enum move_kind kind = s->moves[s->executing ^ 1u].kind;
    if (!move_place_motors(cs)) return false;
    if (kind != MOVE_DWELL) system_motors_come_along(cs);
  } else {
    const uint32_t state = hal_mask_servo();
    if (s->next_valid && !s->placed && !s->end_block && !s->settling) place_virtual(s);
    hal_unmask(state);
  }
  s->first = false;
  cs_busy |= 1u << cs;
  return true;
}

/* Behind the executing move there is one that begins from rest, in the place of the next one or among the segments. */
static bool comes_to_rest(uint32_t cs) {
  const struct move* next = cs_next_move(&coordinate_systems[cs]);
  return paths[cs].count != 0 || (next != 0 && !(next->joins && next->kind == MOVE_PVT));
}

bool move_ends(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  const uint32_t state = hal_mask_servo();
  struct move* m = &s->moves[s->executing];
  const bool overruns = m->kind == MOVE_PVT && m->overruns && !s->placed;
  const bool in_time = overruns && (int32_t)(m->straight - s->ring.executing) >= 0;
  if (in_time && comes_to_rest(cs)) {
    piece_ring_take_back(&s->ring, m->straight + 1u);
    m->overruns = false;
  }
  hal_unmask(state);
  return in_time || !overruns;
}

void move_take_back(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct move *m = &s->moves[s->executing], *next = &s->moves[s->executing ^ 1u];
  if (s->motors != 0 || !s->placed) return;
  s->placed = false;
  next->waited = true; /* until R */
  if (!next->blended) {
    piece_ring_take_back(&s->ring, next->kind == MOVE_LINEAR ? next->straight - 1u : next->straight);
    return;
  }
  m->stop_length = m->acceleration;
  if (s->elapsed > corner(m) - m->stop_length / 2)
    m->stop_length = s->elapsed < corner(m) ? 2 * (corner(m) - s->elapsed) : 0;
  const int64_t stop_begin = corner(m) - m->stop_length / 2;
  const int64_t straight_end = fixed_larger(stop_begin, s->elapsed);
  go_straight(s, straight_end, straight_end);
  add_time(&s->ring, m->stop_length, s->started);
}
