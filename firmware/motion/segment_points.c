#include "firmware/motion/segment_points.h"

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/corner.h"
#include "firmware/motion/lookahead.h"
#include "firmware/motion/path_motors.h"
#include "firmware/motion/plan_move.h"
#include "firmware/motion/segment_ring.h"
#include "firmware/motion/segment_sequence.h"
#include "firmware/motion/system_motors.h"
#include "firmware/variables/i_variables.h"

enum { LAST_POINTS = 3 }; /* the first and the last point of a sequence stand so often */

#define TIME_TOLERANCE 4295 /* 1e-6 ms, by which a point may be before the end and still be it */
#define OVERRIDE_ONE ((uint32_t)SEGMENT_OVERRIDE_ONE)

/* The control point of every motor at a place of the path; the older ones move up. */
static void add_points(uint32_t cs, const struct path_point* point) {
  const bool looks = sequences[cs].looks; /* the lookahead buffer has the older ones */
  path_motors_look(cs, point);
  slice_pause();
  for (uint32_t motor = 0, left = coordinate_systems[cs].motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    int64_t* points = segment_control[motor];
    if (!looks) {
      points[0] = points[1];
      points[1] = points[2];
      points[2] = points[3];
    }
    points[SPLINE_POINTS - 1] = path_motor_at(motor);
    slice_pause();
  }
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
  lookahead_add(cs, (const int64_t(*)[SPLINE_POINTS])segment_control, q->numbers[1], &q->lines[1]);
}

/* A control point has been added. */
static void use_point(uint32_t cs) {
  if (sequences[cs].looks)
    look_at_point(cs);
  else
    segment_ring_add(cs, 0);
}

bool segment_points_begin(uint32_t cs) {
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
  slice_pause();
  piece_set_time(&q->timed, q->period);
  q->timed.continues = false;
  slice_pause();
  path_motors_begin(cs);
  q->looks = false;
  for (uint32_t i = 0; i < LAST_POINTS; i++) add_points(cs, &(struct path_point){.count = 0});
  system_motors_come_along(cs);
  path_of(&paths[cs], 0)->change = path_of(&paths[cs], 0)->acceleration; /* it blends with nothing before it now */
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
  for (uint32_t i = 0; q->looks && i < LAST_POINTS; i++) look_at_point(cs);
  q->made = false;
  if (q->one_move) q->stops = true; /* a stop that has come meanwhile stays one */
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
  const uint32_t present = coordinate_systems[cs].segment_override;
  const uint32_t wanted = override_given(i_variable_read(i_cs_real(cs, ISX15_SEGMENT_OVERRIDE)));
  if (present == wanted) return wanted;
  const double isx16 = i_variable_read(i_cs_real(cs, ISX16_SEGMENT_OVERRIDE_SLEW));
  const bool at_once = !(isx16 > 0.0) || isx16 >= 2.0;
  slice_pause();
  const int64_t change = at_once ? INT64_C(2) * OVERRIDE_ONE : math_to_integer(isx16 * (double)OVERRIDE_ONE);
  return (uint32_t)(present + fixed_within_long((int64_t)wanted - present, change));
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
  const struct sequence* q = &sequences[cs];
  return q->closed || q->stops || q->joined < paths[cs].count;
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
  add_points(cs, &point);
  uint32_t ahead = 0;
  while (ahead + 1u < q->joined && time >= path_begins(p, ahead + 1u)) ahead++;
  set_move(cs, ahead);
  q->time = time;
  coordinate_systems[cs].segment_override = override;
  slice_pause();
  use_point(cs);
}

/* With a stop asked for, moves that have not begun at the last point are not part of it. */
static void leave_out(uint32_t cs) {
  struct sequence* q = &sequences[cs];
  if (q->stops && !q->ends && q->joined > q->under_way + 1u) q->joined = q->under_way + 1u;
}

bool segment_points_make(uint32_t cs, bool starving) {
  struct sequence* q = &sequences[cs];
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

bool segment_points_wait(uint32_t cs) { return decide(cs, next_time(cs, override_of(cs)), false) == WAITS; }
