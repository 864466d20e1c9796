#include "firmware/motion/lookahead_plan.h"

#include "firmware/kernel/slice.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/fixed_ratio.h"
#include "firmware/motion/lookahead_limits.h"
#include "firmware/motion/lookahead_state.h"

enum { STOP_PARTS = PIECE_PARTS / 4 }; /* a stop is at a quarter of a segment */
enum { SLOWEST = 64 };                 /* a w that is no more than the rounding of sums: 0 */

_Static_assert(PIECE_WARP_ONE == RATE_FULL, "a part of 30 bits is both");
#define TIME_MOST ((uint64_t)TRAJECTORY_LONGEST_MS << TRAJECTORY_FRACTION_BITS)

static void load(const struct look* l, uint32_t segment) {
  struct lookahead_record* at = lookahead_at(&l->buffer, segment);
  limits_load(lookahead_of(at), lookahead_of(lookahead_behind(&l->buffer, at)), l->motor_count);
}

/* A part of a segment, in sixteenths of it. */
static void load_part(const struct look* l, uint32_t segment, uint32_t first, uint32_t last) {
  if (last - first == PIECE_PARTS)
    load(l, segment);
  else
    limits_load_part(lookahead_motors(&l->buffer, segment), lookahead_motors(&l->buffer, segment + 1u), l->motor_count,
                     first, last);
}

/* Of w at a knot: the velocities in the segments at both sides. */
static int32_t cap_at(const struct look* l, uint32_t knot) {
  struct lookahead_record* ahead = lookahead_at(&l->buffer, knot);
  if (ahead->stops && !l->backward) return 0;
  const int32_t before = knot == look_oldest(l) ? ahead->cap : lookahead_before(&l->buffer, ahead)->cap;
  return before < ahead->cap || knot == look_end(l) ? before : ahead->cap;
}

enum { STEPS = 4 }; /* of a sweep, before something else has its turn */

/* Sweeps ----------------------------------------------------------------------------------------------------------- */

/* The part of the window in which a sweep does not see its own end. */
static uint32_t spare(const struct look* l) { return l->length / 4u; }

static int32_t* rate_at(const struct look* l, uint32_t knot) { return &lookahead_at(&l->buffer, knot)->rate; }

/* At its first knot, and at its last, a sequence stands whatever w is. */
static bool is_free(const struct look* l, uint32_t knot) {
  return knot == 0 ? look_oldest(l) == 0 : l->closed && knot == look_end(l);
}

static void begin_sweep(struct look* l, uint32_t from) {
  l->sweeping = true;
  l->rates_back = l->backward;
  l->sweep = l->sweep_end = from;
  *rate_at(l, from) = is_free(l, from) ? cap_at(l, from) : 0;
}

static void end_sweep(struct look* l) {
  l->sweeping = false;
  l->swept = l->sweep_end;
  const uint32_t doubtful = l->length - spare(l);
  const bool whole = l->closed && l->swept == look_end(l);
  l->good = whole ? l->swept : l->swept > doubtful ? l->swept - doubtful : 0u;
}

/* What was possible still is, though the search has not come so near to it this time: something before it may count on
 * it. From where nothing is new on all is as it was. */
static void step_back(struct look* l, uint32_t last) {
  const struct lookahead_buffer* b = &l->buffer;
  struct lookahead_record *next = lookahead_at(b, l->sweep), *at = lookahead_before(b, next);
  slice_pause();
  limits_load(lookahead_of(at), lookahead_of(next), l->motor_count);
  const int32_t rate = limits_reach(LIMITS_FIRST, next->rate, cap_at(l, l->sweep - 1u));
  l->sweep--;
  if (l->sweep < l->swept && rate <= at->rate)
    l->sweep = last;
  else
    at->rate = rate;
}

static bool sweep_forward(uint32_t cs, struct look* l, bool hurry) {
  const bool at_free = l->part == 0 && is_free(l, l->front); /* there it may begin with any w */
  const uint32_t end = look_end(l), last = at_free ? l->front : l->front + 1u;
  if (end <= l->front) return false;
  if (!l->sweeping) {
    const bool due = end - l->swept >= spare(l) && (lookahead_is_full(cs) || hurry);
    const bool closes = l->closed && l->good < end;
    if (!due && !closes && !(hurry && end > l->swept)) return false;
    begin_sweep(l, end);
  }
  if (l->sweep <= last) {
    end_sweep(l);
    return true;
  }
  for (uint32_t i = 0; i < STEPS && l->sweep > last; i++) step_back(l, last);
  return true;
}

/* For the way back: from the oldest knot to the front, all of it, before it begins. */
static bool sweep_back(struct look* l) {
  const uint32_t oldest = look_oldest(l), last = l->front + (l->part != 0 ? 1u : 0u);
  if (l->swept_back) return false;
  if (!l->sweeping) {
    begin_sweep(l, oldest);
    return true;
  }
  if (l->sweep >= last) {
    l->sweeping = false;
    l->swept_back = true;
    return true;
  }
  load(l, l->sweep);
  const uint32_t knot = l->sweep + 1u;
  *rate_at(l, knot) = limits_reach(LIMITS_SECOND, *rate_at(l, l->sweep), cap_at(l, knot));
  l->sweep = knot;
  return true;
}

bool lookahead_sweep(uint32_t cs, bool hurry) {
  struct look* l = &looks[cs];
  slice_pause();
  if (!look_is_limited(l) || l->state != LOOK_GOES) return false;
  return l->backward ? sweep_back(l) : sweep_forward(cs, l, hurry);
}

/* Pieces ----------------------------------------------------------------------------------------------------------- */

/* 2 T / (root w0 + root w1); the share of its time and that of the way differ by warp u (1 - u). */
static void set_time(struct look* l, int32_t from, int32_t to, struct lookahead_piece* piece) {
  const uint32_t parts = piece->last > piece->first ? piece->last - piece->first : piece->first - piece->last;
  const uint64_t time = ((uint64_t)l->period << TRAJECTORY_FRACTION_BITS) * parts / PIECE_PARTS;
  piece->warp = 0;
  piece->time = (int64_t)time;
  if (from == RATE_FULL && to == RATE_FULL) return;
  const uint32_t first = l->rooted == from ? l->root : fixed_root((uint32_t)from);
  const uint32_t second = to == from ? first : fixed_root((uint32_t)to);
  l->rooted = to;
  l->root = second;
  slice_pause();
  const struct fixed_divisor by = fixed_divide_by(first + second != 0u ? first + second : 1u);
  /* time 2^31 / sum, that is time 2^(31 + shift) inverse / 2^126 */
  const uint64_t longer = fixed_multiply_high(time << 32, by.inverse) >> (63u - by.shift);
  piece->time = longer < TIME_MOST ? (int64_t)longer : (int64_t)TIME_MOST;
  const int32_t warp = (int32_t)(fixed_part_of(&by, first > second ? first - second : second - first) >> 32);
  piece->warp = first > second ? warp : -warp;
}

/* To `last` sixteenths of a segment, with w there. */
static void hand(struct look* l, uint32_t segment, uint32_t first, uint32_t last, int32_t to,
                 struct lookahead_piece* piece) {
  *piece = (struct lookahead_piece){.segment = segment, .first = first, .last = last, .rate = l->rate};
  set_time(l, l->rate, to, piece);
  piece->number = lookahead_at(&l->buffer, segment + 2u)->number;
  piece->line = lookahead_at(&l->buffer, segment + 2u)->line;
  l->begun = true;
  l->rate = to;
  l->front = last == PIECE_PARTS ? segment + 1u : segment;
  l->part = last % PIECE_PARTS;
}

/* Ahead of the front, in its direction. False: there is none. */
struct next_part {
  uint32_t segment, first, last; /* sixteenths */
  uint32_t knot;                 /* behind it */
};
static bool find_part(const struct look* l, struct next_part* p) {
  if (!l->backward) {
    *p = (struct next_part){l->front, l->part, PIECE_PARTS, l->front + 1u};
    return l->front < look_end(l);
  }
  const uint32_t segment = l->part != 0 ? l->front : l->front - 1u;
  *p = (struct next_part){segment, l->part != 0 ? l->part : PIECE_PARTS, 0, segment};
  return l->part != 0 || l->front > look_oldest(l);
}

static void load_next(const struct look* l, const struct next_part* p, uint32_t last) {
  load_part(l, p->segment, p->first < last ? p->first : last, p->first < last ? last : p->first);
}

static enum limits_end far_end(const struct look* l) { return l->backward ? LIMITS_FIRST : LIMITS_SECOND; }

static void stand(struct look* l) {
  l->state = LOOK_STANDS;
  l->single = false;
  l->rate = 0;
}

/* The least w at the end of what is loaded; below 0: none. A program that is not limited may be beyond the limits. */
static int32_t slowest(const struct look* l, int32_t cap) {
  int32_t least = limits_least(far_end(l), l->rate, cap);
  if (least < 0 && !look_is_limited(l)) {
    const int32_t change = limits_change();
    least = change < l->rate ? l->rate - change : 0;
  }
  return least >= SLOWEST || least < 0 ? least : 0;
}

/* As soon as it can: within the next part, at a quarter of it, or as slow as can be at its end. */
static bool stop(struct look* l, struct lookahead_piece* piece) {
  struct next_part p;
  if (l->rate < SLOWEST || !find_part(l, &p)) {
    stand(l);
    return false;
  }
  const int32_t cap = look_is_limited(l) ? lookahead_at(&l->buffer, p.segment)->cap : RATE_FULL;
  const uint32_t left = l->backward ? p.first - p.last : p.last - p.first; /* a single segment is stopped anywhere */
  for (uint32_t i = STOP_PARTS;; i += STOP_PARTS) {
    const bool over = i >= left;
    const uint32_t last = over ? p.last : l->backward ? p.first - i : p.first + i;
    load_next(l, &p, last);
    const int32_t least = slowest(l, cap);
    if (least != 0 && !over) continue;
    hand(l, p.segment, p.first, last, least >= 0 ? least : l->rate < cap ? l->rate : cap, piece);
    if (l->rate == 0) stand(l);
    return true;
  }
}

/* From rest to the next knot and to rest again, in two parts. */
static bool single(struct look* l, const struct next_part* p, struct lookahead_piece* piece) {
  if (l->rate != 0) { /* the second part */
    hand(l, p->segment, p->first, p->last, 0, piece);
    stand(l);
    return true;
  }
  const uint32_t middle = (p->first + p->last) / 2u;
  const int32_t cap = lookahead_at(&l->buffer, p->segment)->cap;
  load_next(l, p, middle);
  int32_t most = limits_most(far_end(l), 0, cap);
  load_part(l, p->segment, l->backward ? p->last : middle, l->backward ? middle : p->last);
  const int32_t down = limits_most(l->backward ? LIMITS_SECOND : LIMITS_FIRST, 0, cap);
  if (down < most) most = down;
  hand(l, p->segment, p->first, middle, most > 0 ? most : 1, piece);
  return true;
}

/* Whether the front may go on: what the sweep says of the next knot is not about its own end, or time runs short. */
static bool may_go_on(const struct look* l, bool hurry) {
  if (!look_is_limited(l)) return true;
  if (l->backward) return l->swept_back;
  if (l->front + 1u <= l->good) return true;
  if (!hurry || l->front + 1u > l->swept) return false;
  return !l->sweeping || *rate_at(l, l->front + 1u) != 0;
}

/* It has come to a stop of the limit of a desired position. */
static bool is_at_limit(const struct look* l) {
  return l->limits && !l->backward && l->part == 0 && (!l->begun || l->rate == 0) &&
         lookahead_at(&l->buffer, l->front)->stops;
}

/* At the end of the next part, of a path that is limited. */
static int32_t limited_rate(const struct look* l, const struct next_part* p) {
  int32_t to = limits_most(far_end(l), l->rate, *rate_at(l, p->knot));
  /* where rounding leaves none between what two limits ask for: the least is nearest to both */
  if (to < 0) to = limits_least(far_end(l), l->rate, *rate_at(l, p->knot));
  return to < 0 ? *rate_at(l, p->knot) : to;
}

/* Behind a stop: as soon as it may back to the rate of the program, though that is beyond the limits. */
static int32_t rising_rate(const struct look* l) {
  const int32_t to = limits_most(far_end(l), l->rate, RATE_FULL);
  if (to > l->rate) return to;
  const int32_t change = limits_change();
  return change < RATE_FULL - l->rate ? l->rate + change : RATE_FULL;
}

static bool go(struct look* l, bool hurry, struct lookahead_piece* piece) {
  struct next_part p;
  if (!find_part(l, &p)) {
    if (l->backward) stand(l);
    return false;
  }
  if (l->single) return single(l, &p, piece);
  if (is_at_limit(l)) {
    stand(l);
    return false;
  }
  if (!may_go_on(l, hurry)) return false;
  const bool limited = look_is_limited(l);
  if (is_free(l, l->front) && l->part == 0 && (!l->begun || l->rate == 0))
    l->rate = limited ? *rate_at(l, l->front) : RATE_FULL;
  int32_t to = RATE_FULL;
  if (limited || l->rate != RATE_FULL) {
    slice_pause();
    load_next(l, &p, p.last);
    to = limited ? limited_rate(l, &p) : rising_rate(l);
    if (to == 0 && l->rate == 0) {
      if (limited && !l->backward) return false; /* for want of what comes behind it */
      return single(l, &p, piece);
    }
  }
  hand(l, p.segment, p.first, p.last, to, piece);
  return true;
}

bool lookahead_release(uint32_t cs, bool hurry, struct lookahead_piece* piece) {
  struct look* l = &looks[cs];
  slice_pause();
  if (l->state == LOOK_STANDS && l->next != LOOKAHEAD_NONE) {
    const enum lookahead_order order = l->next;
    l->next = LOOKAHEAD_NONE;
    l->backward = order == LOOKAHEAD_BACKWARD || order == LOOKAHEAD_ONE_BACKWARD;
    l->single = l->was_single = order == LOOKAHEAD_ONE_FORWARD || order == LOOKAHEAD_ONE_BACKWARD;
    l->state = LOOK_GOES;
    if (is_at_limit(l)) l->single = true; /* on into the limit a segment at a time */
    look_forget_sweeps(l);
  }
  if (l->state == LOOK_STANDS) return false;
  return l->state == LOOK_STOPS ? stop(l, piece) : go(l, hurry, piece);
}

/* Orders ----------------------------------------------------------------------------------------------------------- */

bool lookahead_is_stored(uint32_t cs, const struct lookahead_piece* piece) {
  return piece->segment >= look_oldest(&looks[cs]);
}

bool lookahead_begins_at_rest(uint32_t cs, const struct lookahead_piece* piece) {
  const uint32_t knot = piece->first == PIECE_PARTS ? piece->segment + 1u : piece->segment;
  return piece->rate < SLOWEST || (piece->first % PIECE_PARTS == 0 && is_free(&looks[cs], knot));
}

void lookahead_take_back(uint32_t cs, const struct lookahead_piece* piece) {
  struct look* l = &looks[cs];
  l->front = piece->first == PIECE_PARTS ? piece->segment + 1u : piece->segment;
  l->part = piece->first % PIECE_PARTS;
  l->rate = piece->rate;
  l->backward = piece->first > piece->last;
  if (l->state == LOOK_STANDS) l->state = LOOK_STOPS;
}

void lookahead_do(uint32_t cs, enum lookahead_order order) {
  struct look* l = &looks[cs];
  l->next = order == LOOKAHEAD_STOP ? LOOKAHEAD_NONE : order;
  if (l->state == LOOK_STANDS) return;
  const bool goes_on = order == (l->backward ? LOOKAHEAD_BACKWARD : LOOKAHEAD_FORWARD);
  struct next_part p;
  const bool valid =
      l->rates_back == l->backward && find_part(l, &p) && (l->backward ? p.knot <= l->valid : p.knot >= l->valid);
  if (!goes_on || l->single || !valid) {
    l->state = LOOK_STOPS;
    return;
  }
  l->next = LOOKAHEAD_NONE;
  l->state = LOOK_GOES;
}

bool lookahead_is_sweeping(uint32_t cs) { return looks[cs].sweeping; }

bool lookahead_rests(uint32_t cs) {
  const struct look* l = &looks[cs];
  return l->rate < SLOWEST || (l->part == 0 && is_free(l, l->front));
}

bool lookahead_stands(uint32_t cs) { return looks[cs].state == LOOK_STANDS && looks[cs].next == LOOKAHEAD_NONE; }

uint32_t lookahead_state(uint32_t cs, bool moves) {
  const struct look* l = &looks[cs];
  const uint32_t direction = l->backward ? 1u : 0u;
  return (moves ? 2u | direction : 0u) | (l->was_single ? 8u | 2u | direction : 0u);
}

bool lookahead_is_wrapped(uint32_t cs) { return look_oldest(&looks[cs]) != 0u; }
bool lookahead_is_backward(uint32_t cs) { return looks[cs].backward; }
bool lookahead_is_at_oldest(uint32_t cs) {
  const struct look* l = &looks[cs];
  return l->backward && l->front == look_oldest(l) && l->part == 0u;
}

bool lookahead_is_at_limit(uint32_t cs) { return looks[cs].state == LOOK_STANDS && is_at_limit(&looks[cs]); }

bool lookahead_is_over(uint32_t cs) {
  const struct look* l = &looks[cs];
  return l->closed && l->state == LOOK_GOES && !l->backward && l->front == look_end(l) && l->part == 0;
}
