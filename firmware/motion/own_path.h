/* The path of one motor that moves on its own: pieces of changing speed, and between them a stay at one speed that may
 * last for ever, in a piece that is repeated. Planner P (real-time task) makes it while the servo task S does not look
 * at it, from start to end; then S goes along it and P reads where it will be. */
#ifndef FIRMWARE_MOTION_OWN_PATH_H
#define FIRMWARE_MOTION_OWN_PATH_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/motion/piece.h"
#include "firmware/motion/speed_profile.h"

#define OWN_PATH_ENDLESS UINT32_MAX
enum { OWN_PATH_PIECES = 8 }; /* two changes of three, and a stay of two */

/* How its speed goes over from that of its begin to that of its end. */
enum own_shape {
  SHAPE_STRAIGHT, /* both are the same */
  SHAPE_EVEN,     /* at one acceleration */
  SHAPE_FROM_0,   /* the acceleration begins at 0 */
  SHAPE_TO_0,     /* it ends at 0 */
  SHAPE_OF_CUBIC  /* known of its cubic alone: a piece of a program */
};

struct own_piece {
  int64_t time; /* trajectory time, above 0 */
  struct cubic cubic;
  double speed;     /* P: at its begin, not rounded; its end is the begin of the next, or rest */
  uint8_t shape;    /* enum own_shape */
  int32_t shift;    /* to the left, of a time: 32 bits of it with `time` in the upper half of their range */
  uint32_t inverse; /* 2^63 / `time` so shifted */
};

struct own_path {
  int64_t elapsed;    /* S: in the piece under way */
  uint32_t executing; /* S; of `count` */
  uint32_t count;     /* P */
  int64_t shift;      /* positions are counted from elsewhere since it was made: added to all that is read */
  /* the stay: piece `repeated` is gone through `repeats` more times, each `carry` / 2^32 further on */
  uint32_t repeated, repeats;
  uint32_t carry, carried;
  int64_t start, end; /* P: as far as it is made */
  double exact;       /* P: from start to end, not rounded */
  struct own_piece pieces[OWN_PATH_PIECES];
};

struct own_path_state {
  double position, speed; /* 1/(32 Ixx08) counts, and of them a ms */
};

/* P */
void own_path_begin(struct own_path* path, int64_t start);
void own_path_change(struct own_path* path, const struct speed_limits* limits, double from, double to);
void own_path_ramp(struct own_path* path, double from, double time); /* to rest, at one deceleration; ms */
void own_path_stay(struct own_path* path, double speed, double time);
void own_path_stay_for_ever(struct own_path* path, double speed); /* nothing may follow */
void own_path_end_at(struct own_path* path, int64_t end);         /* the last piece ends there: less than a few units */

/* S. On by trajectory time; where it is then, or has ended: false. */
bool own_path_advance(struct own_path* path, int32_t increment, int64_t* position);

/* S held off: where it will be `ahead` from now. Numbers are made of what is copied later. */
struct own_path_place {
  struct cubic cubic;
  int64_t time, elapsed; /* beyond its end: it stands there */
  int32_t warp;          /* these as a piece has them */
  uint8_t from, to;
  uint8_t shape;
  double speed, then; /* at begin and end; not of SHAPE_OF_CUBIC */
};
void own_path_place(struct own_path_place* place, const struct own_path* path, int64_t ahead);
void own_path_stands(struct own_path_place* place, int64_t position);
struct own_path_state own_path_state(const struct own_path_place* place);

#endif
