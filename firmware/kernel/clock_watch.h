/* Watches for phase interrupts: whether some IC drives the clocks (global status bit 3). Background task. */
#ifndef FIRMWARE_KERNEL_CLOCK_WATCH_H
#define FIRMWARE_KERNEL_CLOCK_WATCH_H

#include <stdbool.h>

void clock_watch_start(void); /* waits for the first phase interrupt, ten phase periods at most */
void clock_watch_changed(
    void);                    /* a divider or direction was written: watched closely for a while. Real-time task too */
bool clock_watch_close(void); /* the background polls instead of sleeping */
void clock_watch_pass(void);  /* looks at the age of the last phase interrupt */
void clock_watch_poll(void);  /* without clocks: servo and real-time tasks from the cycle counter */

#endif
