/* What wakes the background task. */
#ifndef FIRMWARE_KERNEL_BACKGROUND_H
#define FIRMWARE_KERNEL_BACKGROUND_H

#include <stdint.h>

/* Not 0: there is something to do. Set by any task, cleared by the background. */
extern volatile uint32_t background_work;

static inline void background_wake(void) { background_work = 1; }

#endif
