/* Synchronous assignments M1==, M1&=, M1|=, M1^=: calculated in their place, made when the next move starts. A queue
 * for each coordinate system. Real-time task, in slices: all of them at once would take longer than one. */
#ifndef FIRMWARE_RUN_SYNCHRONOUS_H
#define FIRMWARE_RUN_SYNCHRONOUS_H

#include "firmware/run/motion_program.h"

enum { SYNCHRONOUS_QUEUE = 32 }; /* assignments that wait for one move, or for the executing one and the next */

void synchronous_initialize(void);
bool synchronous_is_short(const struct instruction* in); /* with a constant, in the form of the binary rotary buffer */
/* LATER: no room until the next move starts. ERROR: no room for that many before one move. */
enum executed synchronous_add(uint32_t cs, const struct instruction* in);
bool synchronous_is_move(uint32_t cs);   /* what was planned last is no DWELL: MOVETIME is for it */
void synchronous_move_time(uint32_t cs); /* MOVETIME: the timer Isx11, with the move that was planned last */
bool synchronous_waits(void);            /* there is one whose move may have started */
void synchronous_assign(void);           /* those whose move has started since; pauses behind each */
void synchronous_forget(uint32_t cs);    /* an abort */

#endif
