/* Work in slices. A slice also ends when the real-time task is asked for again: control characters must not wait. */
#include "firmware/kernel/slice.h"

#include <stdbool.h>

#include "firmware/hal/hal.h"

/* R. `inside` is seen true by the work itself only: interrupts above it never pause. */
static void (*work_of_slices)(void);
static bool inside;
static uint32_t began, length;

void slice_restart(void) { hal_side_begin(work_of_slices); }

void slice_initialize(void (*work)(void)) {
  work_of_slices = work;
  inside = false;
  slice_restart();
}

void slice_run(uint32_t cycles) {
  began = hal_cycles();
  length = cycles;
  inside = true;
  hal_side_change();
  inside = false;
}

void slice_pause(void) {
  if (!inside || (hal_cycles() - began < length && !hal_real_time_pending())) return;
  hal_side_change();
}
