/* Eight locks by which tasks of different priorities keep off what they share (LOCK, UNLOCK). They are bits 4 to 11 of
 * I4904; a reset frees all. Background and real-time task. */
#ifndef FIRMWARE_RUN_PROCESS_LOCKS_H
#define FIRMWARE_RUN_PROCESS_LOCKS_H

#include <stdbool.h>
#include <stdint.h>

bool process_lock(uint32_t number); /* 0 to 7. False: it was free, and is the caller's now */
void process_unlock(uint32_t number);

#endif
