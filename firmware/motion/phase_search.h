/* How a motor's phase reference is found (motion:3.5): `$`, power-on, SETPHASE. Motors are numbered from 0 here. */
#ifndef FIRMWARE_MOTION_PHASE_SEARCH_H
#define FIRMWARE_MOTION_PHASE_SEARCH_H

#include <stdbool.h>
#include <stdint.h>

void phasing_search_initialize(void); /* start-up, before interrupts: nothing is searched */

/* `$`: closes the loop of a motor that needs no reference. Else it reads the absolute sensor of Ixx81 and closes the
 * loop, or opens the loop (motor_open) and begins a search; then the loop is closed when that has succeeded
 * (phasing_pass), the motor is killed when it has failed. False: there is no way to find a reference (Ixx74 = 0, a
 * format of Ixx91 that is not read), or the motor may not be enabled. Then status word 2 bit 8 stays as it is.
 * Background, real-time task. */
bool phasing_begin(uint32_t motor);
void phasing_power_on(void); /* background, interrupts on: motors with Ixx80 bit 0 = 1 */
void phasing_servo(void);    /* servo task, before the motors: a step of each search */
void phasing_pass(void);     /* background: what a search that has ended leaves to do */
/* SETPHASE of motors, bit n-1 of motor n: the phase position is Ixx75, at once. Background, real-time task. */
void phasing_set_here(uint32_t of);

#endif
