/* The watchdog of the tasks (firmware:8.3): a counter that the servo task takes down and the background reloads, and
 * the strobe of the hardware watchdog, which stops when the counter has passed 0. */
#ifndef FIRMWARE_KERNEL_WATCHDOG_H
#define FIRMWARE_KERNEL_WATCHDOG_H

#include <stdbool.h>
#include <stdint.h>

void watchdog_initialize(void);
void watchdog_set_reload(uint32_t i40);    /* I40, 0 = 4095; acts at the next reload. Background, real-time task */
void watchdog_reload(void);                /* Y:$25 from I40. Background */
void watchdog_count(void);                 /* servo task */
void watchdog_strobe(uint32_t now);        /* servo and real-time tasks; `now` in CPU cycles */
bool watchdog_strobe_is_old(uint32_t now); /* servo task: it is time for one between two real-time tasks */

#endif
