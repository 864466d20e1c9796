/* Addresses of firmware:1.10 and what stands behind them. */
#include "firmware/motion/live_words.h"

#include "firmware/base/float48.h"
#include "firmware/base/memory_map.h"
#include "firmware/base/status.h"
#include "firmware/hal/hal.h"
#include "firmware/motion/axis_definition.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/motion_status.h"
#include "firmware/motion/motor_status.h"
#include "firmware/variables/i_variables.h"

enum { /* of a motor */
       MOTOR_STATUS_1 = 0x30,
       MOTOR_STATUS_2 = 0x40,
       MOTOR_SCALES = 0x4F, /* X, U, A, B, C; Y, V; Z, W */
       MOTOR_OFFSET = 0x52,
       MOTORS_END = MEMORY_MOTOR_WORDS * (MOTORS + 1)
};

enum { /* of a coordinate system */
       CS_COMMANDED_TIME_BASE = 0x00,
       CS_TIME_BASE = 0x02,
       CS_TIMERS = 0x15,
       CS_STATUS_2 = 0x3F,
       CS_STATUS_1 = 0x40, /* Y: word 3 */
       CS_TARGETS = 0x41,
       CS_END = MEMORY_CS_WORDS + MEMORY_CS_STRIDE * COORDINATE_SYSTEMS
};

static uint32_t half(bool x, double value) {
  const struct float48 word = float48_pack(value);
  return x ? word.x : word.y;
}

/* Counts a unit of the axis that the motor carries: `place` 0 of A, B, C, U, X; 1 of V, Y; 2 of W, Z. */
static double axis_scale(uint32_t motor, uint32_t place) {
  const struct axis_definition* d = &axis_definitions[motor];
  const uint32_t first = AXIS_U + place, second = AXIS_X + place;
  if (d->scale[second] != 0.0) return d->scale[second];
  if (d->scale[first] != 0.0 || place != 0u) return d->scale[first];
  for (uint32_t axis = AXIS_A; axis <= AXIS_C; ++axis)
    if (d->scale[axis] != 0.0) return d->scale[axis];
  return 0.0;
}

static bool motor_word(bool x, uint32_t motor, uint32_t offset, uint32_t* word) {
  if (offset == MOTOR_STATUS_1 && x) {
    *word = motor_status(motor, 0);
  } else if (offset == MOTOR_STATUS_2 && !x) {
    *word = motor_status(motor, 1);
  } else if (offset >= MOTOR_SCALES && offset < MOTOR_OFFSET) {
    *word = half(x, axis_scale(motor, offset - MOTOR_SCALES));
  } else if (offset == MOTOR_OFFSET) {
    *word = half(x, axis_definitions[motor].offset);
  } else {
    return false;
  }
  return true;
}

/* Where the executing move ends; without one where the last has ended. */
static double target(const struct coordinate_system* s, uint32_t axis) {
  const struct move* m = &s->moves[s->executing];
  if (!s->active) return s->position[axis];
  return m->kind == MOVE_LINEAR ? m->start[axis] + m->delta[axis] : m->start[axis];
}

static bool cs_word(bool x, uint32_t cs, uint32_t offset, uint32_t* word) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  if (offset - CS_TARGETS < AXIS_COUNT) {
    *word = half(x, target(s, offset - CS_TARGETS));
    return true;
  }
  switch (offset) {
    case CS_COMMANDED_TIME_BASE:
      *word = (uint32_t)s->increment_command;
      return x;
    case CS_TIME_BASE:
      *word = (uint32_t)s->increment;
      return x;
    case CS_TIMERS:
      *word = (uint32_t)i_integer(i_cs(cs, ISX11_TIMERS) + (x ? 0u : 1u));
      return true;
    case CS_STATUS_2:
      *word = motion_cs_status(cs, 1);
      return !x;
    case CS_STATUS_1:
      *word = motion_cs_status(cs, x ? 0u : 2u);
      return true;
    default:
      return false;
  }
}

bool live_word_read(bool x, uint32_t address, uint32_t* word) {
  if (address - MEMORY_MOTOR_WORDS < MOTORS_END - MEMORY_MOTOR_WORDS)
    return motor_word(x, address / MEMORY_MOTOR_WORDS - 1u, address % MEMORY_MOTOR_WORDS, word);
  if (address - MEMORY_CS_WORDS < CS_END - MEMORY_CS_WORDS)
    return cs_word(x, (address - MEMORY_CS_WORDS) / MEMORY_CS_STRIDE, address % MEMORY_CS_STRIDE, word);
  if (address != MEMORY_GLOBAL_STATUS) return false;
  *word = x ? status_word() : motion_global_status2();
  return true;
}

/* The timers can be set, global status bits that stay can be cleared; the others belong to the firmware. */
bool live_word_write(bool x, uint32_t address, uint32_t word) {
  uint32_t present;
  if (!live_word_read(x, address, &present)) return false;
  if (address == MEMORY_GLOBAL_STATUS && x) status_clear(~word);
  if (address >= MEMORY_CS_WORDS && address % MEMORY_CS_STRIDE == CS_TIMERS)
    i_variable_write(i_cs((address - MEMORY_CS_WORDS) / MEMORY_CS_STRIDE, ISX11_TIMERS) + (x ? 0u : 1u),
                     (double)hal_signed(word));
  return true;
}
