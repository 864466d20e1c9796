/* Filter of the servo loop's output (motion:1.1): F(z) = (1 + N1/z + N2/z^2) / (1 + D1/z + D2/z^2), Ixx36 to Ixx39. */
#ifndef FIRMWARE_MOTION_NOTCH_H
#define FIRMWARE_MOTION_NOTCH_H

#include <stdbool.h>
#include <stdint.h>

void notch_initialize(void);
void notch_motor_changed(uint32_t motor); /* 1..32, servo task held off */
void notch_restart(uint32_t motor);       /* 0..31, servo task held off: as if it had been at rest */
/* 0..31, servo task: outputs with NOTCH_FINER more bits, for poles up to 0.95 multiply an error by 400. */
enum { NOTCH_FINER = 8 };
int64_t notch(uint32_t motor, int64_t output);

extern uint32_t notches_used; /* bit n: motor n has one */
static inline bool notch_is_used(uint32_t motor) { return (notches_used >> motor & 1u) != 0u; }

#endif
