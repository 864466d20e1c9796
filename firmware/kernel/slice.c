/* Work in slices. One ends where the longest way to the next place to leave it would take it beyond its time: the
 * real-time task takes no more than that (host-bus:5.7/5). It also ends when the real-time task is asked for again,
 * because control characters must not wait, and when a line of the host does, because BREQ must not (T_FALL). A host
 * that never stops sending still leaves the slice behind each line its least, and a round its whole slices once it has
 * lasted for PATIENCE_MS. */
#include "firmware/kernel/slice.h"

#include <stdbool.h>

#include "firmware/hal/hal.h"

enum { LEAST_CYCLES = 500, PATIENCE_MS = 5 };
enum { LONGEST_SECTION = 2400 }; /* cycles between two pauses, with what the real-time task does beside the slice */

volatile uint32_t slice_hurry;

/* R. `inside` is seen true by the work itself only: interrupts above it never pause. */
static void (*work_of_slices)(void);
static bool inside;
static uint32_t began, length, round_began;
static uint32_t spent;         /* by the slices before this one */
static volatile bool gave_way; /* the last slice, before its time was over. R, read by B */

static bool works;     /* the round, or the last one, came to a pause: there is something to do */
static bool under_way; /* a round that has begun and has not ended */

static void make_round(void) {
  round_began = hal_cycles();
  under_way = true;
  works = false;
  work_of_slices();
  under_way = false;
}

void slice_restart(void) {
  under_way = false;
  hal_side_begin(make_round);
}

bool slice_is_under_way(void) { return under_way; }
void slice_skip(void) { works = gave_way = false; }

void slice_initialize(void (*work)(void)) {
  work_of_slices = work;
  inside = gave_way = works = false;
  slice_restart();
}

/* The sections of a short slice are seldom the longest: most of it is for work. */
static uint32_t without_last_section(uint32_t cycles) {
  return cycles > 4u * LONGEST_SECTION ? cycles - LONGEST_SECTION : cycles - cycles / 4u;
}

static bool gives_way(uint32_t now) {
  return slice_hurry != 0u && now - round_began < PATIENCE_MS * hal_cycles_per_ms();
}

void slice_run(uint32_t cycles) {
  if (!gave_way) length = without_last_section(cycles);
  began = hal_cycles();
  gave_way = works && gives_way(began);
  if (gave_way) return; /* to the end of the line: a section may take as long as it */
  inside = true;
  hal_side_change();
  inside = false;
  spent += hal_cycles() - began;
}

uint32_t slice_spent(void) { return spent + (hal_cycles() - began); }

static __attribute__((noinline)) void leave(void) {
  const uint32_t now = hal_cycles(), ran = now - began;
  if (ran >= LEAST_CYCLES && gives_way(now)) {
    gave_way = true;
    length = ran < length ? length - ran : 0u; /* what it has left */
  } else if (ran < length && !hal_real_time_pending()) {
    return;
  }
  hal_side_change();
}

/* Called so often that its own cost counts: mostly there is nothing to do. */
void slice_pause(void) {
  if (!inside) return;
  works = true;
  if (hal_cycles() - began >= length || slice_hurry != 0u || hal_real_time_pending()) leave();
}

void slice_hurry_over(void) {
  slice_hurry = 0;
  if (gave_way) hal_request_real_time();
}
