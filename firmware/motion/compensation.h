/* Compensation tables at work (motion:1.4): COMP and BLCOMP change the desired position, TCOMP the
 * output of the servo loop, by where a source motor is. On while I51 = 1. */
#ifndef FIRMWARE_MOTION_COMPENSATION_H
#define FIRMWARE_MOTION_COMPENSATION_H

#include <stdint.h>

void compensation_initialize(void);
void compensation_changed(void); /* tables came or went, or Ixx08 or I51 was written. Background, real-time task */

/* Bit n: motor n is the target of such tables. */
extern uint32_t compensation_of_position, compensation_of_torque;

/* Servo task, motor 0..31, the target. */
int64_t compensation_position(uint32_t motor);               /* position: sum of its COMP tables */
int64_t compensation_backlash(uint32_t motor);               /* position: of its BLCOMP tables */
int64_t compensation_torque(uint32_t motor, int64_t output); /* to be added to `output` */
/* Servo task held off, or in it: positions are counted from elsewhere, trajectory and master are at `place` then. How
 * much more its COMP tables add there than they have added so far. */
int64_t compensation_anew(uint32_t motor, int64_t place);

#endif
