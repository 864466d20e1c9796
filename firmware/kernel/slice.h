/* Work of the real-time task that may take longer than the task: it runs a slice of time at each real-time interrupt
 * and goes on where it stood at the next. It has a stack of its own, so it can be left inside any function; it is left
 * only where it calls slice_pause, so between two of those nothing else sees what it does but interrupts above. */
#ifndef FIRMWARE_KERNEL_SLICE_H
#define FIRMWARE_KERNEL_SLICE_H

#include <stdbool.h>
#include <stdint.h>

void slice_initialize(void (*work)(void)); /* `work` makes one round; what was under way is forgotten */
void slice_restart(void);                  /* the same work; real-time task held off, or that task outside of it */
bool slice_is_under_way(void);             /* real-time task: a round was left before its end */
void slice_skip(void);                     /* real-time task: none is, and a new one would do nothing */
void slice_run(uint32_t cycles);           /* real-time task: a slice, until its time is over or a round is made */
/* Not 0: the background is at a line of the host, from its first character to BREQ. A slice gives way to it after a
 * little work of its own, unless its round has lasted too long already. The host port's interrupt sets it. */
extern volatile uint32_t slice_hurry;
uint32_t slice_spent(void);  /* CPU cycles that slices have had so far, modulo 2^32; within the work */
void slice_hurry_over(void); /* background: the line is done; a slice that gave way goes on */
void slice_pause(void);      /* a place to leave the work; anywhere else, as in the background, it does nothing */

#endif
