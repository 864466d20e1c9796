/* Moves of a system whose paths are made of segments (motion:7.1): LINEAR, CIRCLE and DELAY with Isx13 above 0, in the
 * order of the program, and where their trajectory is at a time. A queue of those that are calculated and not over yet;
 * the first one that does not join ends a sequence of moves that blend.
 *
 *   progress of a move          Each move goes along its own way: its progress rises from 0 to its time, with a change
 *        _/|        /           of velocity at its corner and one at the next corner. In a blend two moves are under
 *      _/  |      _/            way, and what they have made adds up. A straight one so has the velocities of
 *   __/____|____ /              motion:5.2, an arc stays on its circle.
 *
 * Times are of the program, in 2^-32 ms, counted from the corner at which the first move of the queue begins. */
#ifndef FIRMWARE_MOTION_PATH_H
#define FIRMWARE_MOTION_PATH_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/motion/circle.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/fixed_ratio.h"
#include "firmware/motion/plan_linear.h"

enum { PATH_MOVES = 4, PATH_TIME_BITS = 32 };

/* A line of a program and, if that has been called, the line from which everything began. */
struct path_line {
  struct program_place first, last;
  bool called;
};

struct path_move {
  bool joins;           /* blends with the one before it */
  bool sharp, dwells;   /* if not: for its corner; Isx82 counts */
  bool is_arc;          /* X, Y, Z go by `circle`, their deltas are those of its ends */
  bool timed;           /* by TM; else by `feedrate` */
  bool stands;          /* its deltas are what a forward program rounds, no way */
  int64_t time, change; /* Tm; length of the change of velocity at its beginning */
  int64_t acceleration, s_curve;
  struct fixed_divisor by_time;
  double start[AXIS_COUNT], delta[AXIS_COUNT], end[AXIS_COUNT];
  struct circle circle;
  uint32_t absolute;       /* axes that it takes to its end, wherever it begins */
  double told[AXIS_C + 1]; /* of those what its line says, of which rotary axes make an end */
  struct feedrate feedrate;
  uint32_t number; /* as coordinate_system.planned counts */
  struct path_line line;
};

struct path {
  struct path_move moves[PATH_MOVES];
  uint32_t first, count;
};

/* Owner: R; the background while that is held off. */
extern struct path paths[COORDINATE_SYSTEMS];

static inline struct path_move* path_of(struct path* p, uint32_t ahead) {
  return &p->moves[(p->first + ahead) % PATH_MOVES];
}
static inline bool path_is_full(uint32_t cs) { return paths[cs].count == PATH_MOVES; }

/* How far it goes: moves from the first one that belong together, and whether the last of them comes to rest. */
struct path_reach {
  uint32_t count;
  bool stops;
};

#define PATH_WHOLE (INT64_C(1) << 62)

/* Where the trajectory is at a time: the parts of its moves that are made by then. */
struct path_point {
  uint32_t count;
  int64_t parts[PATH_MOVES];
};

int64_t path_time(double milliseconds);
void path_set_time(struct path_move* m, int64_t time);
void path_set_times(struct path_move* m, double time, double acceleration, double s_curve);
/* A move that joins is blended no earlier than `now`: what is before that has been used already. */
void path_blend(struct path* p, uint32_t ahead, int64_t now);
int64_t path_begins(struct path* p, uint32_t ahead); /* its change of velocity */
int64_t path_ends(struct path* p, uint32_t count);   /* behind the stop of the last of `count` moves */
int64_t path_corner(struct path* p, uint32_t ahead);
void path_at(struct path* p, struct path_reach reach, int64_t time, struct path_point* point);
void path_axes_at(struct path* p, const struct path_point* point, double position[AXIS_COUNT]); /* user units */
void path_at_end(uint32_t count, struct path_point* point);                                     /* of so many moves */
int64_t path_pop(struct path* p); /* the first one is over; what to take off times */
/* At the beginning of a move, 0, or its end, 1. */
void path_direction(const struct path_move* m, double part, double direction[AXIS_COUNT]);

#endif
