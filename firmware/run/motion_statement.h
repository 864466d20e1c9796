/* What the statements do that motion programs and rotary buffers have for themselves: moves, modes, rates, calls,
 * synchronous M; and those that they share with PLCs (docs/language.md). Real-time task, in slices. */
#ifndef FIRMWARE_RUN_MOTION_STATEMENT_H
#define FIRMWARE_RUN_MOTION_STATEMENT_H

#include "firmware/run/motion_program.h"

/* `in` as EXECUTED_STATEMENT gives it. WORD, LINE: done, or a move has been planned (next_valid) and it is met again.
 * LATER: nothing more at this interrupt. ERROR: it cannot be executed. */
enum executed motion_statement(uint32_t cs, const struct instruction* in);
/* The axes of the line so far are a move. WORD, or ERROR: it goes by a feedrate that is none. */
enum executed motion_plan_line(uint32_t cs);

#endif
