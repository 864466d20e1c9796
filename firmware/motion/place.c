#include "firmware/motion/place.h"

#include "firmware/hal/hal.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/place_motors.h"

static int64_t corner(const struct move* m) { return m->blend_in / 2 + m->time; }

/* Nobody asks where in it the axes are: it has its time alone. */
static void add_time(struct piece_ring* ring, int64_t time, uint32_t move) {
  *piece_ring_at(ring, ring->added) = (struct piece){.time = time, .end = time, .move = move};
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
  if (!s->active || !next->joins || s->elapsed >= stop_begin) return false;
  int64_t half = next->acceleration / 2;
  if (half > longest) half = longest;
  if (end - half < s->elapsed) half = end - s->elapsed;
  go_straight(s, stop_begin, end - half);
  next->blend_in = 2 * half;
  return true;
}

static void place_virtual(struct coordinate_system* s) {
  struct move* next = &s->moves[s->executing ^ 1u];
  const uint32_t number = s->started + 1u;
  next->blended = next->kind == MOVE_LINEAR && blend(s, next);
  if (!next->blended) next->blend_in = next->acceleration;
  next->stop_length = next->acceleration;
  next->straight_begin = next->blend_in;
  if (next->kind == MOVE_LINEAR) add_time(&s->ring, next->blend_in, number);
  next->straight = s->ring.added;
  if (next->kind == MOVE_DWELL) {
    add_time(&s->ring, next->time, number);
  } else {
    add_time(&s->ring, corner(next) - next->stop_length / 2 - next->blend_in, number);
    add_time(&s->ring, next->stop_length, number);
  }
  s->placed = true;
}

bool move_place(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  if (!s->next_valid || s->placed || s->end_block) return false;
  if (s->motors != 0) {
    if (!move_place_motors(cs)) return false;
  } else {
    const uint32_t state = hal_mask_servo();
    if (s->next_valid && !s->placed && !s->end_block && !s->settling) place_virtual(s);
    hal_unmask(state);
  }
  cs_busy |= 1u << cs;
  return true;
}

void move_take_back(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct move *m = &s->moves[s->executing], *next = &s->moves[s->executing ^ 1u];
  if (s->motors != 0 || !s->placed) return;
  s->placed = false;
  if (!next->blended) {
    piece_ring_take_back(&s->ring, next->kind == MOVE_DWELL ? next->straight : next->straight - 1u);
    return;
  }
  m->stop_length = m->acceleration;
  if (s->elapsed > corner(m) - m->stop_length / 2)
    m->stop_length = s->elapsed < corner(m) ? 2 * (corner(m) - s->elapsed) : 0;
  const int64_t stop_begin = corner(m) - m->stop_length / 2;
  go_straight(s, stop_begin > s->elapsed ? stop_begin : s->elapsed, stop_begin > s->elapsed ? stop_begin : s->elapsed);
  add_time(&s->ring, m->stop_length, s->started);
}
