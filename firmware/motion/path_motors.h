/* Motors along the path of their system, in whole units of position: what each move of the queue is for each of its
 * motors is worked out once, so that a control point costs a few products a motor. Real-time task, in slices. */
#ifndef FIRMWARE_MOTION_PATH_MOTORS_H
#define FIRMWARE_MOTION_PATH_MOTORS_H

#include <stdint.h>

#include "firmware/motion/path.h"

void path_motors_begin(uint32_t cs);                /* a sequence: they stand where its first move begins */
void path_motors_join(uint32_t cs, uint32_t ahead); /* move `ahead` of the queue belongs to it */
void path_motors_pop(uint32_t cs);                  /* the first move is over; before path_pop */

/* Where a motor is: what arcs have for that is worked out once a point. */
void path_motors_look(uint32_t cs, const struct path_point* point);
int64_t path_motor_at(uint32_t motor);

#endif
