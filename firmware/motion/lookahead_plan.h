/* Rates of segments: sweeps, what is handed over next, stops and the way back (motion:7.4, motion:7.5). Real-time task,
 * in slices. */
#ifndef FIRMWARE_MOTION_LOOKAHEAD_PLAN_H
#define FIRMWARE_MOTION_LOOKAHEAD_PLAN_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/motion/lookahead.h"

/* `hurry`: the servo task runs short. False: there is none yet. */
bool lookahead_release(uint32_t cs, bool hurry, struct lookahead_piece* piece);
bool lookahead_sweep(uint32_t cs, bool hurry); /* a step of it; false: nothing was to be done */
bool lookahead_is_sweeping(uint32_t cs);
bool lookahead_is_stored(uint32_t cs, const struct lookahead_piece* piece); /* its points have not been written over */
bool lookahead_begins_at_rest(uint32_t cs, const struct lookahead_piece* piece);
/* The servo task has not begun `piece` and what came behind it, and will not: the front is there again. */
void lookahead_take_back(uint32_t cs, const struct lookahead_piece* piece);
void lookahead_do(uint32_t cs, enum lookahead_order order); /* in either direction it stops first if it has to turn */
bool lookahead_stands(uint32_t cs);                         /* or will, behind what is handed over */
bool lookahead_rests(uint32_t cs);                          /* what is handed over ends at rest */
bool lookahead_is_at_limit(uint32_t cs);                    /* so because of that of a desired position */
bool lookahead_is_wrapped(uint32_t cs);                     /* its oldest segments are written over */
bool lookahead_is_backward(uint32_t cs);                    /* the direction in which it goes, or has gone last */
bool lookahead_is_at_oldest(uint32_t cs);
uint32_t lookahead_state(uint32_t cs, bool moves); /* for Isx21 */
bool lookahead_is_over(uint32_t cs);               /* all of the sequence is handed over */

#endif
