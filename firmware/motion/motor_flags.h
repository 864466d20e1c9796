/* Flags of a motor (0..31): amplifier enable and fault, overtravel limits (motion:1.5, motion:6.2, motion:6.3), as
 * Ixx24, Ixx25, Ixx42 and Ixx43 say. Pointers are resolved when one of these is written. Flags over MACRO are not
 * built: nothing is driven, and no flag is set. */
#ifndef FIRMWARE_MOTION_MOTOR_FLAGS_H
#define FIRMWARE_MOTION_MOTOR_FLAGS_H

#include <stdbool.h>
#include <stdint.h>

void motor_flags_initialize(void);              /* start-up, before variables are taken over */
void motor_flags_motor_changed(uint32_t motor); /* 1..32 */

void motor_flags_enable(uint32_t motor, bool enabled); /* AENA, unless Ixx24 says that it is not used. Servo task held
                                                          off, or servo task */
bool motor_flags_fault(uint32_t motor);                /* amplifier fault */
bool motor_flags_stop(uint32_t motor, int direction);  /* fault, or the limit of that direction (+1, -1, 0: none) */
bool motor_flags_positive_limit(uint32_t motor);       /* PLIM open */
bool motor_flags_negative_limit(uint32_t motor);       /* MLIM open */

#endif
