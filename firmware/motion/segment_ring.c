#include "firmware/motion/segment_ring.h"

#include "firmware/hal/hal.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/lookahead_plan.h"
#include "firmware/motion/segment_sequence.h"

/* Of the pieces of the rings. */
static struct path_line piece_lines[COORDINATE_SYSTEMS][PIECES];
static struct lookahead_piece looked[COORDINATE_SYSTEMS][PIECES] __attribute__((section(".noinit")));

uint32_t segment_ring_ahead(uint32_t cs) {
  const struct piece_ring* ring = &coordinate_systems[cs].ring;
  return ring->added - ring->executing + sequences[cs].unhanded;
}

uint32_t segment_ring_lasts(uint32_t cs, uint32_t enough) {
  struct piece_ring* ring = &coordinate_systems[cs].ring;
  const int64_t period = sequences[cs].period;
  const uint32_t state = hal_mask_servo();
  uint32_t number = ring->executing, segments = 0;
  int64_t time = piece_ring_is_empty(ring) ? 0 : -ring->elapsed;
  hal_unmask(state);
  const uint32_t end = ring->added;
  while (segments < enough && (time > 0 || number != end)) {
    if (time > 0)
      segments++, time -= period;
    else
      time += piece_ring_at(ring, number++)->time;
  }
  return segments;
}

void segment_ring_line(uint32_t cs, struct program_trace* trace) {
  const struct path_line* line = &piece_lines[cs][coordinate_systems[cs].ring.executing % PIECES];
  trace->depth = line->called ? 1u : 0u;
  trace->places[0] = line->first;
  trace->places[trace->depth] = line->last;
}

bool segment_ring_is_dry(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  return sequences[cs].handed && !s->next_valid && !s->active && piece_ring_is_empty(&s->ring);
}

/* The servo task has come to the end of what it had while this was made: on the way, not where it was to stand. */
static bool is_late(uint32_t cs) {
  const uint32_t next = coordinate_systems[cs].ring.added % PIECES;
  if (sequences[cs].unhanded == 0 || !segment_ring_is_dry(cs)) return false;
  return !sequences[cs].looks || !lookahead_begins_at_rest(cs, &looked[cs][next]);
}

void segment_ring_hand_over(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct sequence* q = &sequences[cs];
  const uint32_t state = hal_mask_servo();
  const bool late = piece_ring_is_empty(&s->ring) && is_late(cs);
  if (late)
    s->failure = RUN_TIME_LATE;
  else if (!q->handed)
    s->next_valid = s->placed = true;
  else if (q->unhanded != 0 && !s->placed)
    s->active = true; /* it may have stood: who looks before the servo task does must not take it for over */
  for (; q->unhanded != 0 && !late; q->unhanded--) piece_ring_add(&s->ring);
  hal_unmask(state);
  q->handed = true;
  s->first = false;
  cs_busy |= 1u << cs;
}

/* Between four control points: the last ones, or those of a segment of the lookahead buffer. */
static void set_cubics(uint32_t cs, uint32_t number, struct piece* piece, const struct lookahead_piece* from) {
  struct coordinate_system* s = &coordinate_systems[cs];
  const struct lookahead_motor* at[SPLINE_POINTS];
  piece->motors = 0;
  if (from != 0) lookahead_points(cs, from->segment, at);
  for (uint32_t motor = 0, slot = 0, left = s->motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    struct cubic* c = piece_ring_cubic(&s->ring, number, motor);
    const int64_t* p = segment_control[motor];
    if (from != 0)
      segment_cubic(at[0][slot].point, at[1][slot].point, at[2][slot].point, at[3][slot].point, c);
    else
      segment_cubic(p[0], p[1], p[2], p[3], c);
    if ((c->linear | c->square | c->cube) != 0) piece->motors |= 1u << motor;
    slot++;
    if ((slot & 1u) == 0) slice_pause();
  }
}

void segment_ring_add(uint32_t cs, const struct lookahead_piece* from) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct sequence* q = &sequences[cs];
  const uint32_t number = s->ring.added + q->unhanded;
  struct piece* piece = piece_ring_at(&s->ring, number);
  slice_pause();
  *piece = q->timed;
  if (from != 0 && from->time != q->period) piece_set_time(piece, from->time);
  if (from != 0) {
    piece->warp = from->warp;
    piece->from = (uint8_t)from->first;
    piece->to = (uint8_t)from->last;
    looked[cs][number % PIECES] = *from;
  }
  piece->move = from == 0 ? q->numbers[0] : from->number;
  piece->continues = q->handed || q->unhanded != 0;
  piece_lines[cs][number % PIECES] = from == 0 ? q->lines[0] : from->line;
  slice_pause();
  set_cubics(cs, number, piece, from);
  q->unhanded++;
}

void segment_ring_take_back(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  const int64_t least = (int64_t)SHORT_MS << TRAJECTORY_FRACTION_BITS;
  const uint32_t state = hal_mask_servo();
  uint32_t number = s->ring.executing;
  for (int64_t time = -s->ring.elapsed; number != s->ring.added && time < least; number++)
    time += piece_ring_at(&s->ring, number)->time;
  const uint32_t end = s->ring.added + sequences[cs].unhanded;
  while (number != end && !lookahead_is_stored(cs, &looked[cs][number % PIECES]))
    number++; /* it is executed as it is */
  const uint32_t kept = (int32_t)(number - s->ring.added) > 0 ? number - s->ring.added : 0u;
  if (kept == 0u) piece_ring_take_back(&s->ring, number);
  hal_unmask(state);
  sequences[cs].unhanded = kept;
  if (number != end) lookahead_take_back(cs, &looked[cs][number % PIECES]);
}
