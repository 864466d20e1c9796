/* What PLCs and motion programs do alike beside assignments and logic: ENABLE, DISABLE, PAUSE and RESUME PLC, LOCK and
 * UNLOCK, SEND, COMMAND and DISPLAY. */
#ifndef FIRMWARE_RUN_SHARED_STATEMENTS_H
#define FIRMWARE_RUN_SHARED_STATEMENTS_H

#include "firmware/run/executor.h"
#include "firmware/run/program_output.h"

/* `in` as executor_step gave it (EXECUTED_STATEMENT), in the task that caller->task names. OUTPUT_DONE: executor_pass
 * comes next; OUTPUT_LATER: the step is made again at the next turn; OUTPUT_ILLEGAL: not one of these. */
enum program_output shared_statement(struct executor* x, const struct instruction* in,
                                     const struct program_caller* caller);

#endif
