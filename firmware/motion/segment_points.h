/* Control points of a path (motion:7.1), one after the other: which moves of the queue the sequence is of, as far as
 * that is known, and where it ends. Real-time task, in slices. */
#ifndef FIRMWARE_MOTION_SEGMENT_POINTS_H
#define FIRMWARE_MOTION_SEGMENT_POINTS_H

#include <stdbool.h>
#include <stdint.h>

/* A sequence from the first move of the queue. False: what is before it has to come first. */
bool segment_points_begin(uint32_t cs);
/* The next one. False: it waits for a further move; `starving`: it does not. */
bool segment_points_make(uint32_t cs, bool starving);
bool segment_points_wait(uint32_t cs); /* for that move */

#endif
