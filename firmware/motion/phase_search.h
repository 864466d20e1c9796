/* How a motor's phase reference is found (motion:3.5): `$`, power-on, SETPHASE. Motors are numbered from 0 here. */
#ifndef FIRMWARE_MOTION_PHASE_SEARCH_H
#define FIRMWARE_MOTION_PHASE_SEARCH_H

#include <stdbool.h>
#include <stdint.h>

/* `$` of a commutated motor: reads the absolute sensor of Ixx81, or opens the loop (motor_open) and begins a search;
 * the loop is closed when that has succeeded (phasing_pass), the motor is killed when it has failed. False: there is no
 * way to find one (Ixx74 = 0, a format of Ixx91 that is not read) and status word 2 bit 8 stays 1. */
bool phasing_begin(uint32_t motor);
void phasing_power_on(void);           /* start-up, all layers and interrupts ready: motors with Ixx80 bit 0 = 1 */
void phasing_servo(uint32_t motor);    /* servo task, each servo interrupt: one step of a search, if there is one */
void phasing_pass(void);               /* background: what a search that has ended leaves to do */
void phasing_set_here(uint32_t motor); /* SETPHASE: the phase position is Ixx75, at once. Any task */

#endif
