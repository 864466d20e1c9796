/* Planning of jogs (motion/jog.h): the real-time task, in slices. */
#ifndef FIRMWARE_MOTION_JOG_PLAN_H
#define FIRMWARE_MOTION_JOG_PLAN_H

#include <stdbool.h>

bool jog_plan(void); /* what has been asked for; false: nothing */

#endif
