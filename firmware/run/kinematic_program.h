/* Forward and inverse programs (motion:8.1), executed from their top to their end. Real-time task, in slices: one at a
 * time, there is one planner. */
#ifndef FIRMWARE_RUN_KINEMATIC_PROGRAM_H
#define FIRMWARE_RUN_KINEMATIC_PROGRAM_H

#include "firmware/base/error.h"
#include "firmware/run/executor.h"

/* NONE, or why it was left before its end. */
enum run_time_error kinematic_program_execute(uint32_t cs, enum fixed_kind kind);
/* R, S, PMATCH: ERR015, one that Isx50 asks for is not there; ERR016, the blocks of one do not fit together.
 * Background. */
error_t kinematic_program_check(uint32_t cs);

#endif
