/* Geometry of CIRCLE1 and CIRCLE2 (motion:7.2): an arc in the plane of NORMAL through the axes X, Y, Z, by its centre
 * or its radius. A radius that differs at the two ends changes evenly on the way, a spiral. What the end is out of the
 * plane, and what other axes move, goes evenly too and is not the arc's. Real-time task, in slices. */
#ifndef FIRMWARE_MOTION_CIRCLE_H
#define FIRMWARE_MOTION_CIRCLE_H

#include <stdbool.h>
#include <stdint.h>

enum { CIRCLE_AXES = 3 }; /* X, Y, Z */

struct circle_line {
  double start[CIRCLE_AXES], end[CIRCLE_AXES];
  double vector[CIRCLE_AXES]; /* I, J, K */
  uint32_t vectors;           /* which of them stand in the line */
  bool absolute;              /* they are the centre itself, not the way to it */
  bool by_radius;
  double radius; /* R; below 0: the long way */
  double normal[CIRCLE_AXES];
  bool counter; /* CIRCLE2 */
  double least; /* Isx97: of pi; a shorter arc by I, J, K gets a turn more. 0: 2^-20 */
  double most;  /* Isx96: by which the ends may be further apart than 2 R. 0: no limit */
};

struct circle {
  double centre[CIRCLE_AXES];
  double first[CIRCLE_AXES], second[CIRCLE_AXES]; /* of length 1: to the start, and a quarter of a turn on */
  double along[CIRCLE_AXES]; /* what goes evenly: the way out of the plane; one in it if the arc begins elsewhere */
  double radius, growth;     /* at the start; by how much it is larger at the end */
  double angle;              /* radian, above 0 */
};

enum circle_kind { CIRCLE_ARC, CIRCLE_STRAIGHT, CIRCLE_IMPOSSIBLE };

/* STRAIGHT: neither centre nor radius, or none that the ends determine. */
enum circle_kind circle_of(const struct circle_line* line, struct circle* circle);
/* Of its curve in its plane; and the way out of that. */
double circle_length(const struct circle* circle, double beside[CIRCLE_AXES]);
double circle_least_radius(const struct circle* circle);
/* At the part 0..1 of it; and the direction there, of any length. */
void circle_at(const struct circle* circle, double part, double position[CIRCLE_AXES]);
void circle_direction(const struct circle* circle, double part, double direction[CIRCLE_AXES]);

#endif
