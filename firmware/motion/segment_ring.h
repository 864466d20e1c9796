/* Segments become pieces of the servo task's ring (motion/piece.h), each a B-spline of four control points. They are
 * made behind those that the servo task has, then handed over. Real-time task, in slices. */
#ifndef FIRMWARE_MOTION_SEGMENT_RING_H
#define FIRMWARE_MOTION_SEGMENT_RING_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/lookahead.h"

uint32_t segment_ring_ahead(uint32_t cs); /* pieces that are not executed */
/* How many segments at full speed take as long as what the servo task has; no more than `enough` are counted. */
uint32_t segment_ring_lasts(uint32_t cs, uint32_t enough);
void segment_ring_add(uint32_t cs, const struct lookahead_piece* from); /* 0: of the last control points */
void segment_ring_hand_over(uint32_t cs);
/* Those that the servo task does not come to within SHORT_MS are not made after all. */
void segment_ring_take_back(uint32_t cs);
void segment_ring_line(uint32_t cs, struct program_trace* trace); /* servo task held off: of the executing piece */
bool segment_ring_is_dry(uint32_t cs); /* the servo task has come to the end of what there is */

#endif
