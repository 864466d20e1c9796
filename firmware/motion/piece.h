/* Pieces of a path: cubics of one or more motors over a common time. They are the one joint between what plans motion
 * (moves of programs, jogs, homing) and the servo task, which knows nothing else. A ring of them belongs to each
 * coordinate system and to each motor that moves on its own.
 *
 * Owners: whoever plans fills pieces behind the last and adds them; the servo task goes from piece to piece. What has
 * been added may be taken back while the servo task is held off and has not begun it. */
#ifndef FIRMWARE_MOTION_PIECE_H
#define FIRMWARE_MOTION_PIECE_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/motion/fixed_point.h"

enum { PIECE_PARTS = 16 };
enum { PIECES = 32 };              /* of a ring; a power of two */
enum { PIECE_WARP_ONE = 1 << 30 }; /* the largest `warp` */

/* Position at the part u of its time: start + linear u + square u^2 + cube u^3, positions of motion/fixed_point.h. The
 * end, start + linear + square + cube, is exact. */
struct cubic {
  int64_t start, linear, square, cube;
};

struct piece {
  int64_t time;     /* trajectory time, above 0 */
  int64_t end;      /* when the next one follows: `time`; below it: cut short, 0: passed over */
  uint64_t inverse; /* piece_set_time makes both */
  uint32_t shift;
  uint8_t from, to; /* sixteenths of the cubics; `from` is above `to` when they are gone through backwards */
  int32_t warp; /* after the part p of its time the part u = p + warp p (1 - p) of its way: the rate changes evenly */
  uint32_t motors; /* slots of the ring that have a cubic in it; the others stand */
  uint32_t move;   /* which move of its coordinate system it belongs to, counted by who plans */
  bool continues;  /* of a sequence of such moves that is one for the servo task: not its first piece */
};

struct piece_ring {
  struct piece pieces[PIECES];
  struct cubic* cubics;        /* PIECES times `width` */
  uint32_t width;              /* slots: motors of a coordinate system, or 1 */
  volatile uint32_t executing; /* S: counts pieces that are over; the one under way has this number */
  volatile uint32_t added;     /* planner: pieces so far; the ring is empty when both are equal */
  int64_t elapsed;             /* S: in the executing piece */
  uint32_t fraction;           /* S: the same, of its time */
};

void piece_ring_initialize(struct piece_ring* ring, struct cubic* cubics, uint32_t width);

static inline bool piece_ring_is_empty(const struct piece_ring* ring) { return ring->executing == ring->added; }
static inline uint32_t piece_ring_room(const struct piece_ring* ring) {
  return PIECES - (ring->added - ring->executing);
}
static inline struct piece* piece_ring_at(struct piece_ring* ring, uint32_t number) {
  return &ring->pieces[number % PIECES];
}
static inline struct cubic* piece_ring_cubic(struct piece_ring* ring, uint32_t number, uint32_t slot) {
  return &ring->cubics[(number % PIECES) * ring->width + slot];
}

/* Planner: piece number `added` is filled, with room for it, then counted. */
void piece_set_time(struct piece* piece, int64_t time); /* 1 to 2^47 */
void piece_ring_add(struct piece_ring* ring);
/* Servo task held off: the pieces from `number` on are forgotten, which must not be the executing one or older. */
void piece_ring_take_back(struct piece_ring* ring, uint32_t number);
/* The same while an older one executes: piece `number` is left after `end`, those behind it are passed over, and
 * `count` filled ones behind them follow. False, with nothing changed: the servo task is beyond that end already. */
bool piece_ring_replace(struct piece_ring* ring, uint32_t number, int64_t end, uint32_t count);
void piece_ring_clear(struct piece_ring* ring); /* servo task held off */

/* Servo task. On by `increment` of trajectory time, into the next pieces if need be; false: the ring has run empty, and
 * what is beyond the end is lost. */
bool piece_ring_advance(struct piece_ring* ring, int64_t increment);

int64_t piece_end(const struct piece* piece, const struct cubic* cubic); /* where it ends */

static inline int64_t cubic_at(const struct cubic* cubic, uint32_t fraction) {
  const int64_t square = cubic->square + fixed_part(cubic->cube, fraction);
  const int64_t linear = cubic->linear + fixed_part(square, fraction);
  return cubic->start + fixed_part(linear, fraction);
}

int64_t cubic_end(const struct cubic* cubic);

#endif
