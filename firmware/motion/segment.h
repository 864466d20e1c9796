/* Segments (motion:7.1): control points of the path of a system, one every Isx13 ms of its program, and pieces of the
 * uniform cubic B-spline through their neighbourhood. A sequence of moves that blend is one move of the ring. Real-time
 * task, in slices. */
#ifndef FIRMWARE_MOTION_SEGMENT_H
#define FIRMWARE_MOTION_SEGMENT_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/lookahead.h"

/* One control point more, if there is room and need. `alone`: no further line comes at this interrupt, so what runs
 * short is brought to its end. False: nothing was to be done. */
bool segment_work(uint32_t cs, bool alone);
bool segment_is_busy(uint32_t cs); /* moves wait, or a sequence has not been made to its end */
bool segment_is_under_way(uint32_t cs);
/* A move of another kind may be calculated. False: the sequence comes to its end for it. Until that is made a stop may
 * leave moves out, and nothing may be calculated that begins where they end. */
bool segment_gives_way(uint32_t cs);
void segment_stop(uint32_t cs); /* the sequence ends with the move that is under way; later ones wait for R, S */
bool segment_is_left(uint32_t cs);
void segment_go_on(uint32_t cs, bool one_move); /* R: those that wait may begin; S: the first of them */
/* Background: of a sequence that is looked ahead. */
bool segment_looks(uint32_t cs);
void segment_order(uint32_t cs, enum lookahead_order order);
bool segment_stands(uint32_t cs);                                /* by such an order */
void segment_forget(uint32_t cs);                                /* servo task held off: all of it, an abort */
void segment_start_of(uint32_t cs, double position[AXIS_COUNT]); /* where the moves that wait begin */
void segment_begin_at(uint32_t cs, double position[AXIS_COUNT]); /* they do there; it becomes where they end */

#endif
