/* Addresses of firmware:1.10 and what stands behind them. */
#include "firmware/motion/live_words.h"

#include "firmware/base/float48.h"
#include "firmware/base/memory_map.h"
#include "firmware/base/status.h"
#include "firmware/hal/hal.h"
#include "firmware/motion/axis_definition.h"
#include "firmware/motion/conversion_entry.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/motion_status.h"
#include "firmware/motion/motor_status.h"
#include "firmware/motion/phasing.h"
#include "firmware/motion/servo_words.h"
#include "firmware/motion/time_base.h"
#include "firmware/variables/i_variables.h"

enum { /* of a motor; those of the servo loop: motion/servo_words.h */
       MOTOR_STATUS_1 = 0x30,
       MOTOR_STATUS_2 = 0x40,
       MOTOR_STATUS_PHASE_REFERENCE = 8, /* a bit of it */
       MOTOR_SCALES = 0x4F,              /* X, U, A, B, C; Y, V; Z, W */
       MOTOR_OFFSET = 0x52
};

enum { /* of a coordinate system */
       CS_COMMANDED_TIME_BASE = 0x00,
       CS_TIME_BASE = 0x02,
       CS_ERROR = 0x14, /* Y */
       CS_TIMERS = 0x15,
       CS_STATUS_2 = 0x3F,
       S2_RUN_TIME_ERROR_BIT = 1 << 22,
       CS_STATUS_1 = 0x40, /* Y: word 3 */
       S1_CONTINUOUS_BIT = 1 << 4,
       CS_END = MEMORY_CS_WORDS + MEMORY_CS_STRIDE * COORDINATE_SYSTEMS
};

static const unsigned HALF_X = 1, HALF_Y = 2, BOTH = 3; /* which halves were made */

static void set_float(double value, uint32_t* x, uint32_t* y) {
  const struct float48 word = float48_pack(value);
  *x = word.x;
  *y = word.y;
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

static unsigned motor_word(uint32_t motor, uint32_t offset, uint32_t* x, uint32_t* y) {
  if (offset == MOTOR_STATUS_1) {
    *x = motor_status(motor, 0);
    return HALF_X;
  }
  if (offset == MOTOR_STATUS_2) {
    *y = motor_status(motor, 1);
    return HALF_Y;
  }
  if (offset < MOTOR_SCALES || offset > MOTOR_OFFSET) return servo_word_read(motor, offset, x, y);
  set_float(offset == MOTOR_OFFSET ? axis_definitions[motor].offset : axis_scale(motor, offset - MOTOR_SCALES), x, y);
  return BOTH;
}

/* Where the executing move ends; without one where the last has ended, which is where one that waits begins. The servo
 * task changes from move to move, the real-time task writes the position: both are held off for the copy only. */
static double target(const struct coordinate_system* s, uint32_t axis) {
  const uint32_t state = hal_mask_servo();
  const struct move *m = &s->moves[s->executing], *next = &s->moves[s->executing ^ 1u];
  const bool moves = s->active && m->kind != MOVE_DWELL;
  const double delta = m->delta[axis];
  double start = s->position[axis];
  if (s->active)
    start = m->start[axis];
  else if (s->next_valid)
    start = next->start[axis];
  hal_unmask(state);
  return moves ? start + delta : start;
}

static unsigned cs_word(uint32_t cs, uint32_t offset, uint32_t* x, uint32_t* y) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  if (offset - MEMORY_CS_TARGETS < AXIS_COUNT) {
    set_float(target(s, offset - MEMORY_CS_TARGETS), x, y);
    return BOTH;
  }
  switch (offset) {
    case CS_COMMANDED_TIME_BASE:
      *x = (uint32_t)s->increment_command;
      return HALF_X;
    case CS_TIME_BASE:
      *x = (uint32_t)s->increment;
      return HALF_X;
    case CS_ERROR:
      *y = (uint32_t)s->error;
      return HALF_Y;
    case CS_TIMERS:
      *x = (uint32_t)i_integer(i_cs(cs, ISX11_TIMERS));
      *y = (uint32_t)i_integer(i_cs(cs, ISX11_TIMERS) + 1u);
      return BOTH;
    case CS_STATUS_2:
      *y = motion_cs_status(cs, 1);
      return HALF_Y;
    case CS_STATUS_1:
      *x = motion_cs_status(cs, 0);
      *y = motion_cs_status(cs, 2);
      return BOTH;
    default:
      return 0;
  }
}

/* Whose word it is, from 0; MOTORS and more: of none. */
static uint32_t motor_at(uint32_t address) { return address / MEMORY_MOTOR_WORDS - 1u; }

static unsigned make(uint32_t address, uint32_t* x, uint32_t* y) {
  const uint32_t motor = motor_at(address);
  if (motor < MOTORS) return motor_word(motor, address % MEMORY_MOTOR_WORDS, x, y);
  if (address - MEMORY_CS_WORDS < CS_END - MEMORY_CS_WORDS)
    return cs_word((address - MEMORY_CS_WORDS) / MEMORY_CS_STRIDE, address % MEMORY_CS_STRIDE, x, y);
  if (address - MEMORY_CONVERSION < CONVERSION_LINES) {
    *y = (uint32_t)i_integer(I8000_CONVERSION_TABLE + (address - MEMORY_CONVERSION));
    return HALF_Y;
  }
  if (address != MEMORY_GLOBAL_STATUS) return 0;
  *x = status_word();
  *y = motion_global_status2();
  return BOTH;
}

bool live_word_read(uint32_t address, uint32_t* x, uint32_t* y) { return make(address, x, y) != 0u; }

static void write_timer(uint32_t number, uint32_t mask, uint32_t bits) {
  uint32_t word = bits;
  const uint32_t state = hal_mask_real_time();
  if (mask != HAL_WORD_MASK) word |= (uint32_t)i_integer(number) & ~mask;
  i_timer_write(number, hal_signed(word));
  hal_unmask(state);
}

/* A number below 0 stops the trajectory as 0 does. */
static void write_time_base(uint32_t cs, uint32_t mask, uint32_t bits) {
  const uint32_t state = hal_mask_real_time();
  const int32_t value = hal_signed(((uint32_t)coordinate_systems[cs].increment_command & ~mask) | bits);
  time_base_command(cs, value < 0 ? 0 : value);
  hal_unmask(state);
}

/* How a kinematic program says that there is no such place; the program that runs is stopped (motion:8.1/8);
 * without one it means nothing. */
static void run_time_error_by_user(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  const uint32_t state = hal_mask_real_time();
  if (s->failure == RUN_TIME_NONE) s->failure = RUN_TIME_BY_USER;
  hal_unmask(state);
}

/* What a write leaves of a word is read in one piece with it: programs of the real-time task write there too. */
static void write_cs(uint32_t cs, uint32_t offset, bool x, uint32_t mask, uint32_t bits) {
  if (offset == CS_COMMANDED_TIME_BASE) write_time_base(cs, mask, bits);
  if (offset == CS_STATUS_1 && x && (mask & S1_CONTINUOUS_BIT) != 0u)
    coordinate_systems[cs].unblended = (bits & S1_CONTINUOUS_BIT) == 0u;
  if (offset == CS_STATUS_2 && !x && (mask & bits & S2_RUN_TIME_ERROR_BIT) != 0u) run_time_error_by_user(cs);
  if (offset == CS_TIMERS) write_timer(i_cs(cs, ISX11_TIMERS) + (x ? 0u : 1u), mask, bits);
}

/* A user who has set the phase position clears the phase reference error. */
static void write_reference(uint32_t motor, uint32_t offset, bool x, uint32_t mask, uint32_t bits) {
  const uint32_t bit = 1u << MOTOR_STATUS_PHASE_REFERENCE;
  if (offset == MOTOR_STATUS_2 && !x && (mask & bit) != 0u) phasing_set_missing(motor, (bits & bit) != 0u);
}

/* A variable O command. The register is read where it stands: the servo task writes it. */
static void write_output(uint32_t motor, uint32_t offset, bool x, uint32_t mask, uint32_t bits) {
  if (x && motor < MOTORS && offset == MEMORY_MOTOR_FILTER_OUTPUT) servo_word_write_output(motor, mask, bits);
}

/* The commanded time base, blending (bit 4 of status word 1), the run-time error (bit 22 of word 2), the timers and the
 * phase reference error can be set, global status bits that stay can be cleared; the others belong to the firmware. */
bool live_word_write(bool x, uint32_t address, uint32_t mask, uint32_t bits) {
  uint32_t present[2];
  const uint32_t motor = motor_at(address), offset = address % MEMORY_MOTOR_WORDS;
  write_output(motor, offset, x, mask, bits);
  if ((make(address, &present[1], &present[0]) & (x ? HALF_X : HALF_Y)) == 0u) return false;
  if (address == MEMORY_GLOBAL_STATUS && x) status_clear(mask & ~bits);
  const uint32_t in_systems = address - MEMORY_CS_WORDS;
  if (in_systems < MEMORY_CS_STRIDE * COORDINATE_SYSTEMS)
    write_cs(in_systems / MEMORY_CS_STRIDE, in_systems % MEMORY_CS_STRIDE, x, mask, bits);
  if (motor < MOTORS) {
    write_reference(motor, offset, x, mask, bits);
    servo_word_write(motor, offset, x, mask, bits);
  }
  const uint32_t line = address - MEMORY_CONVERSION;
  if (line < CONVERSION_LINES) i_variable_write_part(I8000_CONVERSION_TABLE + line, mask, bits);
  return true;
}

bool live_word_write_long(uint32_t address, uint32_t x, uint32_t y) {
  const uint32_t motor = motor_at(address);
  return motor < MOTORS && servo_word_write_long(motor, address % MEMORY_MOTOR_WORDS, x, y);
}
