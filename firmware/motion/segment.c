#include "firmware/motion/segment.h"

#include "firmware/hal/hal.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/lookahead_plan.h"
#include "firmware/motion/path.h"
#include "firmware/motion/plan_anew.h"
#include "firmware/motion/segment_points.h"
#include "firmware/motion/segment_ring.h"
#include "firmware/motion/segment_sequence.h"
#include "firmware/variables/i_variables.h"

bool segment_is_busy(uint32_t cs) { return sequences[cs].runs || (paths[cs].count != 0 && !sequences[cs].stops); }

bool segment_is_under_way(uint32_t cs) { return sequences[cs].runs; }

bool segment_gives_way(uint32_t cs) {
  struct sequence* q = &sequences[cs];
  if (!q->runs) return true;
  q->closed = true;
  return false;
}

/* What executes or stands is of the sequence that is made, no move before it. */
static bool has_begun(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  const struct move* next = cs_next_move(s);
  const bool waits = next != 0 && next->kind == MOVE_SEGMENTS;
  return sequences[cs].handed ? !waits : !s->active;
}

/* While the last pieces of a sequence are executed too, as long as nothing is placed behind them. */
bool segment_looks(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  const bool ends = s->active && s->moves[s->executing].kind == MOVE_SEGMENTS && !s->next_valid;
  return sequences[cs].looks && (sequences[cs].runs ? has_begun(cs) : ends);
}

void segment_order(uint32_t cs, enum lookahead_order order) {
  const uint32_t state = hal_mask_real_time();
  if (segment_looks(cs)) {
    sequences[cs].runs = true;
    sequences[cs].order = order;
  }
  hal_unmask(state);
}

bool segment_stands(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  return sequences[cs].runs && sequences[cs].looks && sequences[cs].order == LOOKAHEAD_NONE && lookahead_stands(cs) &&
         !s->active && has_begun(cs) && piece_ring_is_empty(&s->ring);
}

void segment_stop(uint32_t cs) {
  if (segment_is_busy(cs)) sequences[cs].stops = true;
}

bool segment_is_left(uint32_t cs) { return paths[cs].count != 0; }

void segment_go_on(uint32_t cs, bool one_move) {
  sequences[cs].stops = false;
  sequences[cs].one_move = one_move;
}

/* Isx21 */
static void show(uint32_t cs, uint32_t state) {
  const uint32_t shown = (uint32_t)i_integer(i_cs(cs, ISX21_LOOKAHEAD_STATE));
  if (shown != state) i_variable_set_lookahead_state(cs, state);
}

void segment_forget(uint32_t cs) {
  if (sequences[cs].looks) show(cs, 0);
  sequences[cs].runs = sequences[cs].looks = sequences[cs].stops = false;
  paths[cs].count = 0;
}

void segment_start_of(uint32_t cs, double position[AXIS_COUNT]) {
  if (paths[cs].count == 0) return;
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) position[axis] = path_of(&paths[cs], 0)->start[axis];
}

void segment_begin_at(uint32_t cs, double position[AXIS_COUNT]) {
  if (paths[cs].count != 0) plan_anew(cs, position);
}

static bool work_at_once(uint32_t cs, bool alone) {
  struct sequence* q = &sequences[cs];
  if (!segment_points_make(cs, alone && segment_ring_ahead(cs) <= q->least)) return false;
  if (q->handed || q->made || q->unhanded > q->least) segment_ring_hand_over(cs);
  q->runs = !q->made;
  return true;
}

static bool release(uint32_t cs, bool hurry) {
  struct sequence* q = &sequences[cs];
  struct lookahead_piece piece;
  if (!lookahead_release(cs, hurry, &piece)) return false;
  segment_ring_add(cs, &piece);
  const bool over = q->made && lookahead_is_over(cs);
  if (q->handed || over || lookahead_stands(cs) || q->unhanded > q->least) segment_ring_hand_over(cs);
  q->runs = !over || q->order != LOOKAHEAD_NONE; /* one may have come in a pause of this */
  return true;
}

static void obey(uint32_t cs) {
  struct sequence* q = &sequences[cs];
  const enum lookahead_order order = q->order;
  q->order = LOOKAHEAD_NONE;
  segment_ring_take_back(cs);
  lookahead_do(cs, order);
}

/* Through the lookahead buffer: what can be handed over comes first, then what makes that possible. */
static bool go_ahead(uint32_t cs, bool alone) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  struct sequence* q = &sequences[cs];
  const uint32_t executing = s->ring.executing;
  q->rests = false;
  if (q->order != LOOKAHEAD_NONE) obey(cs);
  if (q->made && lookahead_is_over(cs)) {
    segment_ring_hand_over(cs);
    q->runs = false;
    return true;
  }
  const uint32_t ahead = segment_ring_ahead(cs);
  const bool room = ahead < q->most, hurry = q->handed && ahead <= q->least;
  const bool soon = hurry || (q->handed && ahead <= q->least + 1u && !s->next_valid && !path_is_full(cs));
  const bool grows = !q->made && !lookahead_is_full(cs);
  /* lines are calculated until then, and no more before what still executes has come to its end */
  const bool begins = !q->handed && (q->made || segment_ring_lasts(cs, q->least + 2u) <= q->least + 1u);
  if (room && release(cs, false)) return true;
  /* a long sweep is not waited for: what the one before it has found still holds */
  if (q->handed && ahead <= (q->least + 1u) / 2u && lookahead_is_sweeping(cs)) {
    if (release(cs, true)) return true;
  }
  if (lookahead_sweep(cs, false)) return true;
  /* what has no next line in time comes to its end, before it has to stop where nothing more is known */
  if (soon && grows && alone && segment_points_wait(cs)) return segment_points_make(cs, true);
  if (hurry && ((room && release(cs, true)) || lookahead_sweep(cs, true))) return true;
  if (grows) {
    if (segment_points_make(cs, false)) return true;
    if (!alone) return false;
    /* what is known will not be more for now */
    if (begins && lookahead_sweep(cs, true)) return true;
    if (begins && room && release(cs, true)) return true;
  }
  if (begins && q->unhanded != 0) {
    segment_ring_hand_over(cs);
    return true;
  }
  q->rests = !grows && s->active;
  q->rested = executing;
  return false;
}

static bool work_ahead(uint32_t cs, bool alone) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  if (go_ahead(cs, alone)) return true;
  show(cs, lookahead_state(cs, s->active && s->moves[s->executing].kind == MOVE_SEGMENTS));
  return false;
}

/* The servo task has executed the sequence that was looked ahead: it stands. */
static __attribute__((noinline)) void end_look(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  const struct move* next = cs_next_move(s);
  const bool waits = !s->active && next != 0 && next->kind == MOVE_SEGMENTS;
  if (waits || (s->active && s->moves[s->executing].kind == MOVE_SEGMENTS)) return;
  sequences[cs].looks = false;
  show(cs, 0);
}

static __attribute__((noinline)) bool work(uint32_t cs, bool alone) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct sequence* q = &sequences[cs];
  if (!q->runs) {
    if (q->looks) end_look(cs);
    return paths[cs].count != 0 && segment_points_begin(cs);
  }
  slice_pause();
  if (segment_ring_is_dry(cs) && !(q->looks && lookahead_rests(cs))) {
    s->failure = RUN_TIME_LATE;
    return false;
  }
  if (q->looks) return work_ahead(cs, alone);
  return segment_ring_ahead(cs) < q->most && work_at_once(cs, alone);
}

bool segment_work(uint32_t cs, bool alone) {
  const struct sequence* q = &sequences[cs];
  const bool rests = q->runs && q->rests && q->rested == coordinate_systems[cs].ring.executing;
  return (!rests || q->order != LOOKAHEAD_NONE) && work(cs, alone);
}
