/* Faults of the firmware itself: a trap that no interrupt makes. The outputs go off, what happened is kept over the
 * restart that follows, and stands in memory where a host reads it: X:$70 cause (mcause, bit 23 for its bit 31), Y:$70
 * faults since power-on, D:$71 program counter, D:$72 address that was accessed. */
#ifndef FIRMWARE_IMAGE_FAULT_H
#define FIRMWARE_IMAGE_FAULT_H

#include <stdbool.h>
#include <stdint.h>

/* image/trap.S, on an empty stack. False: the start itself fails, nothing can be done but to wait for the watchdog. */
bool fault_take(uint32_t cause, uint32_t pc, uint32_t address);
void fault_show(void);       /* start-up, after memory has been cleared */
void fault_start_done(void); /* the background runs */

#endif
