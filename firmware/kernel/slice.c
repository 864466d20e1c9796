/* Work in slices. A slice also ends when the real-time task is asked for again, because control characters must not
 * wait, and when a line of the host does, because BREQ must not (host-bus:5.7, T_FALL). A host that never stops sending
 * still leaves each slice its least, and a round its whole slices once it has lasted for PATIENCE_MS. */
#include "firmware/kernel/slice.h"

#include <stdbool.h>

#include "firmware/hal/hal.h"

enum { LEAST_CYCLES = 500, PATIENCE_MS = 5 };

volatile uint32_t slice_hurry;

/* R. `inside` is seen true by the work itself only: interrupts above it never pause. */
static void (*work_of_slices)(void);
static bool inside;
static uint32_t began, length, round_began;
static volatile bool gave_way; /* the last slice, before its time was over. R, read by B */

static void make_round(void) {
  round_began = hal_cycles();
  work_of_slices();
}

void slice_restart(void) { hal_side_begin(make_round); }

void slice_initialize(void (*work)(void)) {
  work_of_slices = work;
  inside = gave_way = false;
  slice_restart();
}

void slice_run(uint32_t cycles) {
  if (!gave_way) length = cycles;
  gave_way = false;
  began = hal_cycles();
  inside = true;
  hal_side_change();
  inside = false;
}

void slice_pause(void) {
  if (!inside) return;
  const uint32_t now = hal_cycles(), ran = now - began;
  if (slice_hurry != 0u && ran >= LEAST_CYCLES && now - round_began < PATIENCE_MS * hal_cycles_per_ms()) {
    gave_way = true;
    length = ran < length ? length - ran : 0u; /* what it has left */
  } else if (ran < length && !hal_real_time_pending()) {
    return;
  }
  hal_side_change();
}

void slice_hurry_over(void) {
  slice_hurry = 0;
  if (gave_way) hal_request_real_time();
}
