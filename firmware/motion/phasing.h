/* Which motors have a phase reference: status word 2, bits 8 and 9. Motors are numbered from 0 here. A loop of a motor
 * whose reference is missing cannot be closed. How one is found: motion/phase_search.h. */
#ifndef FIRMWARE_MOTION_PHASING_H
#define FIRMWARE_MOTION_PHASING_H

#include <stdbool.h>
#include <stdint.h>

void phasing_initialize(void);              /* power-up, $$$ and $$$***, after the I-variables */
void phasing_motor_changed(uint32_t motor); /* 1..32: Ixx01, Ixx78 or Ixx96 was written */
bool phasing_is_needed(uint32_t motor);     /* a synchronous motor that the phase task commutates. Any task */
bool phasing_is_missing(uint32_t motor);    /* bit 8. Any task */
bool phasing_is_searched(uint32_t motor);   /* bit 9. Any task */
extern volatile uint32_t phasing_missing, phasing_searched; /* of all motors, bit n-1 of motor n */
/* Background and real-time task; users may write bit 8 too. */
void phasing_set_missing(uint32_t motor, bool missing);
void phasing_set_searched(uint32_t motor, bool searched);

#endif
