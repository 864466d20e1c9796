/* The sequence of a system that is being made, as the parts of its making share it (motion/segment.h): control points
 * of its path, pieces for the servo task, what is to be done next. */
#ifndef FIRMWARE_MOTION_SEGMENT_SEQUENCE_H
#define FIRMWARE_MOTION_SEGMENT_SEQUENCE_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/lookahead_order.h"
#include "firmware/motion/path.h"
#include "firmware/motion/segment_piece.h"

enum {
  LEFT_OF_RING = 4, /* pieces of the ring that are for whatever follows */
  SHORT_MS = 12,    /* of segments ahead of the servo task: what has no next move by then comes to its end */
  AHEAD_MS = 24     /* more than so much is not made */
};

/* Owner: R, but for what is marked. */
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
  bool one_move;                       /* so does the next one, with its first move. B sets */
  uint32_t joined;
  uint32_t points;      /* that are still to be made behind its end */
  uint32_t unhanded;    /* pieces behind those that the servo task has */
  int64_t period;       /* Isx13 */
  uint32_t least, most; /* pieces ahead of the servo task: what is SHORT_MS, and all that are made */
  int64_t time;         /* of the last point, as path.h has it */
  struct piece timed;   /* a piece of that period */
  uint32_t under_way;   /* moves of the queue that have begun at the last point, less one */
  /* number and line of the move at the last two points */
  uint32_t numbers[2];
  struct path_line lines[2];
};

extern struct sequence sequences[COORDINATE_SYSTEMS];
/* The last control points of a motor, which belongs to one system. */
extern int64_t segment_control[MOTORS][SPLINE_POINTS];

#endif
