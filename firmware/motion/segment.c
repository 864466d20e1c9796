#include "firmware/motion/segment.h"

#include "firmware/base/mathematics.h"
#include "firmware/hal/hal.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/corner.h"
#include "firmware/motion/lookahead_plan.h"
#include "firmware/motion/path.h"
#include "firmware/motion/path_motors.h"
#include "firmware/motion/plan_move.h"
#include "firmware/motion/segment_piece.h"
#include "firmware/motion/system_motors.h"
#include "firmware/variables/i_variables.h"

enum {
  ISX16 = 1,        /* behind Isx15 */
  LEFT_OF_RING = 4, /* pieces of the ring that are for whatever follows */
  LAST_POINTS = 3,  /* the first and the last point of a sequence stand so often */
  SHORT_MS = 12,    /* of segments ahead of the servo task: what has no next move by then comes to its end */
  AHEAD_MS = 24     /* more than so much is not made */
};

#define TIME_TOLERANCE 4295     /* 1e-6 ms, by which a point may be before the end and still be it */
#define OVERRIDE_ONE (1u << 30) /* Isx15 = 0 */

/* The sequence that is being made. Owner: R, but for what is marked. */
struct sequence {
  bool late; /* the next move has not come in time: the last one goes straight on, to its stop at most */
  bool runs;
  bool rests; /* nothing was to be done but when the servo task has come further than this */
  uint32_t rested;
  bool handed;                         /* the servo task has its first pieces */
  bool ends;                           /* it is known where: behind `joined` moves of the queue */
  bool looks;                          /* its segments go through the lookahead buffer */
  bool made;                           /* all its points are */
  volatile enum lookahead_order order; /* B; R takes it */
  bool closed;                         /* no further move joins: one of another kind waits for its place */
  bool stops;                          /* segment_stop: at the end of the move that is under way. B sets */
  uint32_t joined;
  uint32_t points;      /* that are still to be made behind its end */
  uint32_t unhanded;    /* pieces behind those that the servo task has */
  int64_t period;       /* Isx13 */
  uint32_t least, most; /* pieces ahead of the servo task: what is SHORT_MS, and all that are made */
  uint32_t override;    /* as it is now */
  int64_t time;         /* of the last point, as path.h has it */
  struct piece timed;   /* a piece of that period */
  uint32_t under_way;   /* moves of the queue that have begun at the last point, less one */
  /* number and line of the move at the last two points */
  uint32_t numbers[2];
  struct path_line lines[2];
};

static struct sequence sequences[COORDINATE_SYSTEMS];
/* The last control points of a motor, which belongs to one system. */
static int64_t control[MOTORS][SPLINE_POINTS];
/* Of the pieces of the rings. */
static struct path_line piece_lines[COORDINATE_SYSTEMS][PIECES];
static struct lookahead_piece looked[COORDINATE_SYSTEMS][PIECES] __attribute__((section(".noinit")));

static uint32_t ahead_of(const struct coordinate_system* s) { return s->ring.added - s->ring.executing; }

bool segment_is_busy(uint32_t cs) { return sequences[cs].runs || (paths[cs].count != 0 && !sequences[cs].stops); }

bool segment_is_under_way(uint32_t cs) { return sequences[cs].runs; }

bool segment_gives_way(uint32_t cs) {
  struct sequence* q = &sequences[cs];
  if (!q->runs) return true;
  if (q->handed && !(q->looks && lookahead_may_hold(cs))) return true; /* it is known where that will end */
  q->closed = true;
  return false;
}

/* While the last pieces of a sequence are executed too, as long as nothing is placed behind them. */
bool segment_looks(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  const bool ends = s->active && s->moves[s->executing].kind == MOVE_SEGMENTS && !s->next_valid;
  return sequences[cs].looks && (sequences[cs].runs || ends);
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
         !s->active && !s->next_valid && piece_ring_is_empty(&s->ring);
}

void segment_stop(uint32_t cs) {
  if (segment_is_busy(cs)) sequences[cs].stops = true;
}

void segment_go_on(uint32_t cs) { sequences[cs].stops = false; }

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

void segment_line(uint32_t cs, struct program_trace* trace) {
  const struct path_line* line = &piece_lines[cs][coordinate_systems[cs].ring.executing % PIECES];
  trace->depth = line->called ? 1u : 0u;
  trace->places[0] = line->first;
  trace->places[trace->depth] = line->last;
}

/* The control point of every motor at a place of the path; the older ones move up. */
static void add_points(uint32_t cs, const struct path_point* point) {
  const bool looks = sequences[cs].looks; /* the lookahead buffer has the older ones */
  path_motors_look(cs, point);
  for (uint32_t motor = 0, left = coordinate_systems[cs].motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    int64_t* points = control[motor];
    for (uint32_t i = 0; !looks && i + 1u < SPLINE_POINTS; i++) points[i] = points[i + 1u];
    points[SPLINE_POINTS - 1] = path_motor_at(motor);
    slice_pause();
  }
}

static void hand_over(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct sequence* q = &sequences[cs];
  const uint32_t state = hal_mask_servo();
  if (!q->handed)
    s->next_valid = s->placed = true;
  else if (q->unhanded != 0 && !s->placed)
    s->active = true; /* it may have stood: who looks before the servo task does must not take it for over */
  for (; q->unhanded != 0; q->unhanded--) piece_ring_add(&s->ring);
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
    const int64_t* p = control[motor];
    if (from != 0)
      segment_cubic(at[0][slot].point, at[1][slot].point, at[2][slot].point, at[3][slot].point, c);
    else
      segment_cubic(p[0], p[1], p[2], p[3], c);
    if ((c->linear | c->square | c->cube) != 0) piece->motors |= 1u << motor;
    slot++;
    if ((slot & 1u) == 0) slice_pause();
  }
}

static void add_piece(uint32_t cs, const struct lookahead_piece* from) {
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

/* Move `ahead` of the queue is the one at the last point. */
static void set_move(uint32_t cs, uint32_t ahead) {
  struct sequence* q = &sequences[cs];
  const struct path_move* m = path_of(&paths[cs], ahead);
  q->under_way = ahead;
  q->numbers[0] = q->numbers[1];
  q->lines[0] = q->lines[1];
  q->numbers[1] = m->number;
  q->lines[1] = m->line;
}

static void set_ahead(struct sequence* q, uint32_t period) {
  q->least = 1u + SHORT_MS / period;
  q->most = q->least + 2u + (AHEAD_MS - SHORT_MS) / period;
  if (q->most > PIECES - LEFT_OF_RING) q->most = PIECES - LEFT_OF_RING;
}

static void look_at_point(uint32_t cs) {
  const struct sequence* q = &sequences[cs];
  lookahead_add(cs, (const int64_t(*)[SPLINE_POINTS])control, q->numbers[1], &q->lines[1]);
}

/* A control point has been added. */
static void use_point(uint32_t cs) {
  if (sequences[cs].looks)
    look_at_point(cs);
  else
    add_piece(cs, 0);
}

/* False: what is before it has to come first. */
static bool begin(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct sequence* q = &sequences[cs];
  const struct path_move* m = path_of(&paths[cs], 0);
  if (s->next_valid || q->stops) return false;
  struct move* slot = plan_begin(cs, MOVE_SEGMENTS);
  slice_pause();
  slot->joins = slot->blended = slot->overruns = false;
  slot->is_sharp = m->sharp;
  slot->has_dwell = m->dwells;
  slot->time = slot->blend_in = 0;
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    slot->start[axis] = m->start[axis];
    slot->delta[axis] = m->delta[axis];
  }
  if (corner_waits(cs)) return false;
  const int32_t period = i_integer(i_cs(cs, ISX13_SEGMENTATION_TIME));
  q->period = (int64_t)(period > 0 ? period : 1) << TRAJECTORY_FRACTION_BITS;
  set_ahead(q, (uint32_t)(period > 0 ? period : 1));
  q->override = OVERRIDE_ONE;
  slice_pause();
  piece_set_time(&q->timed, q->period);
  q->timed.continues = false;
  slice_pause();
  path_motors_begin(cs);
  q->looks = false;
  for (uint32_t i = 0; i < SPLINE_POINTS; i++) add_points(cs, &(struct path_point){.count = 0});
  system_motors_come_along(cs);
  slice_pause();
  q->time = path_begins(&paths[cs], 0);
  set_move(cs, 0);
  set_move(cs, 0);
  q->handed = q->ends = q->closed = q->late = q->rests = false;
  q->order = LOOKAHEAD_NONE;
  q->joined = 1;
  q->unhanded = 0;
  q->points = LAST_POINTS;
  slice_pause();
  q->looks = lookahead_begin(cs, (uint32_t)(period > 0 ? period : 1));
  for (uint32_t i = 0; q->looks && i + 1u < SPLINE_POINTS; i++) look_at_point(cs);
  q->made = false;
  q->runs = true;
  return true;
}

/* Isx15 and what it asks of the rate, 0 to 2. */
static uint32_t override_given(double isx15) {
  if (isx15 == 0.0) return OVERRIDE_ONE;
  const double wanted = isx15 < -1.0 ? 0.0 : isx15 > 1.0 ? 2.0 : isx15 + 1.0;
  slice_pause();
  return (uint32_t)math_to_integer(wanted * (double)OVERRIDE_ONE);
}

/* As Isx15 has it for the next segment: it goes to a new value by Isx16 a segment. */
static uint32_t override_of(uint32_t cs) {
  const uint32_t present = sequences[cs].override;
  const uint32_t wanted = override_given(i_variable_read(i_cs_real(cs, ISX15_SEGMENT_OVERRIDE)));
  if (present == wanted) return wanted;
  const double isx16 = i_variable_read(i_cs_real(cs, ISX15_SEGMENT_OVERRIDE) + ISX16);
  const bool at_once = !(isx16 > 0.0) || isx16 >= 2.0;
  slice_pause();
  const uint32_t change = at_once ? 2u * OVERRIDE_ONE : (uint32_t)math_to_integer(isx16 * (double)OVERRIDE_ONE);
  if (wanted > present) return wanted - present <= change ? wanted : present + change;
  return present - wanted <= change ? wanted : present - change;
}

/* Program time of the next point, `override` on from the last one. */
static int64_t next_time(uint32_t cs, uint32_t override) {
  const struct sequence* q = &sequences[cs];
  const int64_t step = q->period << (PATH_TIME_BITS - TRAJECTORY_FRACTION_BITS);
  return q->time + (override == OVERRIDE_ONE ? step : fixed_share(step, (int64_t) override << 31) * 2);
}

/* Moves of the queue that belong to the sequence, each joined to the one before it no earlier than the last point. */
static void join(uint32_t cs) {
  struct sequence* q = &sequences[cs];
  struct path* p = &paths[cs];
  while (!q->ends && !q->stops && q->joined < p->count && path_of(p, q->joined)->joins) {
    path_motors_join(cs, q->joined);
    path_blend(p, q->joined++, q->time);
    q->late = false;
  }
}

/* No move can join any more. */
static bool is_last(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  const struct sequence* q = &sequences[cs];
  if (q->closed || q->stops || q->joined < paths[cs].count) return true;
  return q->handed && s->next_valid && s->moves[s->executing ^ 1u].kind != MOVE_SEGMENTS;
}

enum decision { GOES_ON, ENDS, WAITS };

/* What the point at `time` needs is known, the sequence ends, or a next move may still change it. */
static enum decision decide(uint32_t cs, int64_t time, bool starving) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct sequence* q = &sequences[cs];
  struct path* p = &paths[cs];
  const struct path_move* m = path_of(p, q->joined - 1u);
  if (time <= path_corner(p, q->joined - 1u) + m->change / 2) return GOES_ON;
  if (is_last(cs) || s->quit || !s->running || !s->may_join) return ENDS;
  slice_pause();
  if (starving) q->late = true;
  if (!q->late) return WAITS;
  const int64_t stop = path_corner(p, q->joined);
  if (time <= stop + stop - path_ends(p, q->joined)) return GOES_ON;
  return starving ? ENDS : WAITS;
}

/* Moves that are over before the point at `time`. */
static void drop_moves(uint32_t cs, int64_t* time) {
  struct sequence* q = &sequences[cs];
  struct path* p = &paths[cs];
  while (q->joined > 1u && *time >= path_corner(p, 1) + path_of(p, 1)->change / 2) {
    path_motors_pop(cs);
    const int64_t over = path_pop(p);
    *time -= over;
    q->time -= over;
    q->joined--;
    if (q->under_way != 0) q->under_way--;
  }
}

/* The last point of a sequence, once more each time. */
static void make_end(uint32_t cs) {
  struct sequence* q = &sequences[cs];
  struct path* p = &paths[cs];
  struct path_point end;
  path_at_end(q->joined, &end);
  add_points(cs, &end);
  set_move(cs, q->joined - 1u);
  use_point(cs);
  if (--q->points != 0) return;
  for (; q->joined != 0; q->joined--) (void)path_pop(p);
  q->made = true;
  if (q->looks) lookahead_close(cs);
}

static void make_point(uint32_t cs, int64_t time, uint32_t override) {
  struct sequence* q = &sequences[cs];
  struct path* p = &paths[cs];
  struct path_point point;
  slice_pause();
  path_at(p, (struct path_reach){q->joined, q->ends}, time, &point);
  slice_pause();
  add_points(cs, &point);
  uint32_t ahead = 0;
  while (ahead + 1u < q->joined && time >= path_begins(p, ahead + 1u)) ahead++;
  set_move(cs, ahead);
  q->time = time;
  q->override = override;
  slice_pause();
  use_point(cs);
}

/* With a stop asked for, moves that have not begun at the last point are not part of it. */
static void leave_out(uint32_t cs) {
  struct sequence* q = &sequences[cs];
  if (q->stops && !q->ends && q->joined > q->under_way + 1u) q->joined = q->under_way + 1u;
}

/* The servo task has come to the end of what there is. */
static bool is_dry(const struct coordinate_system* s, const struct sequence* q) {
  return q->handed && !s->next_valid && !s->active && piece_ring_is_empty(&s->ring);
}

/* The next point of the path. False: it waits for a further move. */
static bool make_next(uint32_t cs, bool starving) {
  struct sequence* q = &sequences[cs];
  slice_pause();
  leave_out(cs);
  join(cs);
  slice_pause();
  const uint32_t override = override_of(cs);
  int64_t time = next_time(cs, override);
  drop_moves(cs, &time);
  slice_pause();
  if (!q->ends) {
    const enum decision decision = decide(cs, time, starving);
    if (decision == WAITS) return false;
    q->ends = decision == ENDS;
  }
  if (q->ends && time > path_ends(&paths[cs], q->joined) - TIME_TOLERANCE)
    make_end(cs);
  else
    make_point(cs, time, override);
  return true;
}

static bool work_at_once(uint32_t cs, bool alone) {
  struct sequence* q = &sequences[cs];
  if (!make_next(cs, alone && ahead_of(&coordinate_systems[cs]) + q->unhanded <= q->least)) return false;
  if (q->handed || q->made || q->unhanded > q->least) hand_over(cs);
  q->runs = !q->made;
  return true;
}

static bool release(uint32_t cs, bool hurry) {
  struct sequence* q = &sequences[cs];
  struct lookahead_piece piece;
  if (!lookahead_release(cs, hurry, &piece)) return false;
  add_piece(cs, &piece);
  const bool over = q->made && lookahead_is_over(cs);
  if (q->handed || over || lookahead_stands(cs) || q->unhanded > q->least) hand_over(cs);
  q->runs = !over;
  return true;
}

/* Pieces that the servo task does not come to within SHORT_MS are not made after all. */
static void take_back(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  const int64_t least = (int64_t)SHORT_MS << TRAJECTORY_FRACTION_BITS;
  const uint32_t state = hal_mask_servo();
  uint32_t number = s->ring.executing;
  for (int64_t time = -s->ring.elapsed; number != s->ring.added && time < least; number++)
    time += piece_ring_at(&s->ring, number)->time;
  const bool any = number != s->ring.added || sequences[cs].unhanded != 0;
  piece_ring_take_back(&s->ring, number);
  hal_unmask(state);
  sequences[cs].unhanded = 0;
  if (any) lookahead_take_back(cs, &looked[cs][number % PIECES]);
}

static void obey(uint32_t cs) {
  struct sequence* q = &sequences[cs];
  const enum lookahead_order order = q->order;
  q->order = LOOKAHEAD_NONE;
  take_back(cs);
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
    hand_over(cs);
    q->runs = false;
    return true;
  }
  const uint32_t ahead = ahead_of(s) + q->unhanded;
  const bool room = ahead < q->most, hurry = q->handed && ahead <= q->least;
  const bool soon = hurry || (q->handed && ahead <= q->least + 1u && !s->next_valid && !path_is_full(cs));
  const bool grows = !q->made && !lookahead_is_full(cs);
  if ((room && release(cs, false)) || lookahead_sweep(cs, false)) return true;
  /* what has no next line in time comes to its end, before it has to stop where nothing more is known */
  if (soon && grows && alone && decide(cs, next_time(cs, override_of(cs)), false) == WAITS) return make_next(cs, true);
  if (hurry && ((room && release(cs, true)) || lookahead_sweep(cs, true))) return true;
  if (grows) {
    if (make_next(cs, false)) return true;
    if (!alone) return false;
    /* what is known will not be more for now */
    if (!q->handed && lookahead_sweep(cs, true)) return true;
    if (!q->handed && room && release(cs, true)) return true;
  }
  if (!q->handed && q->unhanded != 0) {
    hand_over(cs);
    return true;
  }
  q->rests = !grows && s->active;
  q->rested = executing;
  return false;
}

static bool work_ahead(uint32_t cs, bool alone) {
  if (go_ahead(cs, alone)) return true;
  show(cs, lookahead_state(cs, coordinate_systems[cs].active));
  return false;
}

/* The servo task has executed the sequence that was looked ahead: it stands. */
static __attribute__((noinline)) void end_look(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  const bool waits = !s->active && s->next_valid && s->moves[s->executing ^ 1u].kind == MOVE_SEGMENTS;
  if (waits || (s->active && s->moves[s->executing].kind == MOVE_SEGMENTS)) return;
  sequences[cs].looks = false;
  show(cs, 0);
}

static __attribute__((noinline)) bool work(uint32_t cs, bool alone) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct sequence* q = &sequences[cs];
  if (!q->runs) {
    if (q->looks) end_look(cs);
    return paths[cs].count != 0 && begin(cs);
  }
  slice_pause();
  if (q->looks) return work_ahead(cs, alone);
  if (is_dry(s, q)) {
    s->failure = RUN_TIME_LATE;
    return false;
  }
  return ahead_of(s) + q->unhanded < q->most && work_at_once(cs, alone);
}

bool segment_work(uint32_t cs, bool alone) {
  const struct sequence* q = &sequences[cs];
  const bool rests = q->runs && q->rests && q->rested == coordinate_systems[cs].ring.executing;
  return (!rests || q->order != LOOKAHEAD_NONE) && work(cs, alone);
}
