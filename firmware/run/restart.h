/* `ABR{n}` (motion:5.6/8): an abort, and a program that begins when all stands. Background task. */
#ifndef FIRMWARE_RUN_RESTART_H
#define FIRMWARE_RUN_RESTART_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/error.h"

/* Not `has_number`: the program that the pointer is in, from its top. ERR015: aborted, but there is none. */
error_t restart_begin(uint32_t cs, bool has_number, double program);
void restart_pass(void); /* starts what may start by now; an error other than a motion in progress ends it */

#endif
