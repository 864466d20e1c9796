/* What lookahead knows of the sequence of a system. Owner: R. */
#ifndef FIRMWARE_MOTION_LOOKAHEAD_STATE_H
#define FIRMWARE_MOTION_LOOKAHEAD_STATE_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/dimensions.h"
#include "firmware/motion/lookahead_buffer.h"
#include "firmware/motion/lookahead_order.h"
#include "firmware/motion/segment_piece.h"

enum { LOOKAHEAD_KEPT = 8 }; /* records behind the front that are not written over */

enum look_state { LOOK_GOES, LOOK_STOPS, LOOK_STANDS };

struct look {
  struct lookahead_buffer buffer;
  uint32_t length;  /* Isx20, as far as the buffer has room */
  bool limits;      /* Isx20 above 1: of the program, too; else of what orders ask for */
  bool closed;      /* the points so far are all */
  uint32_t guarded; /* motors whose desired positions are limited */
  uint32_t motors, motor_count;
  uint32_t period; /* ms */
  uint32_t added;  /* points so far */
  /* the front: what is before it, in the direction of motion, has been handed over */
  uint32_t front, part; /* so many sixteenths into the segment of this number, forwards */
  int32_t rate;         /* w there */
  int32_t rooted;       /* the last w of which the root was taken, and that */
  uint32_t root;
  bool begun; /* something has been handed over */
  enum look_state state;
  bool backward;
  enum lookahead_order next; /* once it stands */
  bool was_single;           /* the last order was that */
  bool single;               /* to the next knot only */
  /* sweep */
  bool sweeping;
  uint32_t sweep, sweep_end; /* the last knot that it has done; where it began */
  uint32_t swept;            /* the end of the last sweep */
  uint32_t good;             /* knots up to this one do not depend on where that stopped */
  bool rates_back;           /* the rates of the records are those for the way back, */
  uint32_t valid;            /* from this knot on in that direction */
  bool swept_back;           /* the knots behind have been swept for the way back */
};

extern struct look looks[COORDINATE_SYSTEMS];

/* The last knot, behind which nothing is known. */
static inline uint32_t look_end(const struct look* l) {
  return l->added < SPLINE_POINTS ? 0u : l->added - SPLINE_POINTS + 1u;
}
/* The first one that is still stored. */
static inline uint32_t look_oldest(const struct look* l) {
  return l->added > l->buffer.records ? l->added - l->buffer.records : 0u;
}
/* The way back and stops keep to the limits whatever the program does. */
static inline bool look_is_limited(const struct look* l) { return l->limits || l->backward; }
/* For a new direction: nothing of the sweeps counts. */
static inline void look_forget_sweeps(struct look* l) {
  l->sweeping = l->swept_back = false;
  l->swept = l->good = l->front;
  l->valid = l->backward ? l->front : l->front + (l->begun ? 1u : 0u);
}

#endif
