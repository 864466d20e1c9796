/* Compensation tables at work (motion:1.4): COMP and BLCOMP change the desired position, TCOMP the
 * output of the servo loop, by where a source motor is. On while I51 = 1. */
#ifndef FIRMWARE_MOTION_COMPENSATION_H
#define FIRMWARE_MOTION_COMPENSATION_H

#include <stdbool.h>
#include <stdint.h>

void compensation_initialize(void);
void compensation_changed(void); /* tables came or went, or Ixx08 or I51 was written. Background, real-time task */

/* Bit n: motor n is the target of such tables. */
extern uint32_t compensation_of_position, compensation_of_torque;

/* Servo task, motor 0..31, the target. */
int64_t compensation_position(uint32_t motor);               /* position: sum of its COMP tables */
int64_t compensation_backlash(uint32_t motor);               /* position: of its BLCOMP tables */
int64_t compensation_torque(uint32_t motor, int64_t output); /* to be added to `output` */
/* 0..31, any task: what its COMP tables will add when positions are counted so that it is at `place`, trajectory and
 * master of a loop that is closed, else its actual position. The servo task is held off for a table at a time. */
int64_t compensation_there(uint32_t motor, bool closed, int64_t place);
uint32_t compensation_changes(void); /* another number after any change of tables */
/* Servo task held off, or in it: they add `sum` from now on. How much more that is than so far; 0 where it has none. */
int64_t compensation_exchange(uint32_t motor, int64_t sum);

#endif
