/* Sine and cosine of both phases at an angle. */
#ifndef FIRMWARE_MOTION_PHASE_TABLE_H
#define FIRMWARE_MOTION_PHASE_TABLE_H

#include <stdint.h>

#include "firmware/hal/hal.h"
#include "firmware/motion/phase_motor.h"
#include "firmware/motion/sine_table.h"

struct phase_sines {
  int32_t cosine, sine;
};

/* 24 bits to the upper ones of 32. */
static inline struct phase_sines phase_sines(const struct phase_settings* s, uint32_t angle) {
  const uint32_t address = s->table + (angle >> (32 - SINE_BITS));
  return (struct phase_sines){(int32_t)(*hal_x(address) << 8), (int32_t)(*hal_y(address) << 8)};
}

#endif
