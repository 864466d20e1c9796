/* Planning of moves (firmware:7.5): fills the move of a coordinate system that is not executing. Real-time task. */
#ifndef FIRMWARE_MOTION_PLAN_H
#define FIRMWARE_MOTION_PLAN_H

#include <stdbool.h>

#include "firmware/language/word.h"

bool plan_line(uint32_t cs); /* to the pending axis targets; false: it would need a feedrate, and that is not above 0 */
void plan_wait(uint32_t cs, enum rate kind, double milliseconds); /* RATE_DWELL, RATE_DELAY */

#endif
