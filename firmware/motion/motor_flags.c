#include "firmware/motion/motor_flags.h"

#include "firmware/base/dimensions.h"
#include "firmware/hal/hal.h"
#include "firmware/variables/i_variables.h"
#include "firmware/variables/words.h"
#include "rtl/regs/brick_regs.h"

enum { /* Ixx24 */
       ENABLE_NOT_USED = 1 << 16,
       LIMITS_IGNORED = 1 << 17,
       OVER_MACRO_SHIFT = 18,
       FAULT_IGNORED = 1 << 20,
       FAULT_IS_HIGH = 1 << 23
};
enum over_macro { OVER_NONE, OVER_CAPTURE_AND_AMPLIFIER, OVER_AMPLIFIER, OVER_CAPTURE };

static struct flags {
  volatile uint32_t* control;                  /* of the amplifier enable; 0: there is none */
  const volatile uint32_t *amplifier, *limits; /* 0: nobody looks */
  bool fault_is_high, enabled;
} flags[MOTORS];

static uint32_t address_of(uint32_t motor, uint32_t which) {
  const uint32_t own = (uint32_t)i_integer(i_motor(motor, IXX42_AMPLIFIER_FLAG_ADDRESS) + which);
  return own != 0u ? own : (uint32_t)i_integer(i_motor(motor, IXX25_FLAG_ADDRESS));
}

static volatile uint32_t* word_of(uint32_t address) { return word_exists(true, address) ? hal_x(address) : 0; }

/* EQU write would act again. */
static void write_enable(volatile uint32_t* control, bool enabled) {
  if (control == 0) return;
  const uint32_t others = *control & ~(SERVO_CHANNEL_CONTROL_AENA_MASK | SERVO_CHANNEL_CONTROL_EQU_WRITE_MASK);
  *control = enabled ? others | SERVO_CHANNEL_CONTROL_AENA_MASK : others;
}

void motor_flags_initialize(void) { __builtin_memset(flags, 0, sizeof flags); }

void motor_flags_motor_changed(uint32_t motor) {
  struct flags* f = &flags[motor - 1u];
  const uint32_t mode = (uint32_t)i_integer(i_motor(motor, IXX24_FLAG_MODE));
  const uint32_t amplifier = address_of(motor, 0), limits = address_of(motor, 1);
  const enum over_macro over = (enum over_macro)(mode >> OVER_MACRO_SHIFT & 3u);
  const bool local_amplifier = amplifier != 0u && (over == OVER_NONE || over == OVER_CAPTURE);
  const bool local_limits = limits != 0u && (over == OVER_NONE || over == OVER_AMPLIFIER);
  const bool drives = local_amplifier && (mode & ENABLE_NOT_USED) == 0u;
  volatile uint32_t* control = drives ? word_of(amplifier + SERVO_CHANNEL_X_CONTROL) : 0;
  const uint32_t state = hal_mask_servo();
  if (control != f->control) { /* the enable goes with the motor */
    write_enable(f->control, false);
    f->control = control;
    if (f->enabled) write_enable(control, true);
  }
  f->amplifier = local_amplifier && (mode & FAULT_IGNORED) == 0u ? word_of(amplifier) : 0;
  f->limits = local_limits && (mode & LIMITS_IGNORED) == 0u ? word_of(limits) : 0;
  f->fault_is_high = (mode & FAULT_IS_HIGH) != 0u;
  hal_unmask(state);
}

void motor_flags_enable(uint32_t motor, bool enabled) {
  flags[motor].enabled = enabled;
  write_enable(flags[motor].control, enabled);
}

bool motor_flags_fault(uint32_t motor) {
  const struct flags* f = &flags[motor];
  if (f->amplifier == 0) return false;
  return ((*f->amplifier & SERVO_CHANNEL_STATUS_FAULT_MASK) != 0u) == f->fault_is_high;
}

static bool limit(uint32_t motor, uint32_t mask) {
  const volatile uint32_t* word = flags[motor].limits;
  return word != 0 && (*word & mask) != 0u;
}

/* A register of an IC makes the CPU wait: both are bits of one word, usually. */
bool motor_flags_stop(uint32_t motor, int direction) {
  const struct flags* f = &flags[motor];
  const volatile uint32_t *amplifier = f->amplifier, *limits = f->limits;
  uint32_t word = 0;
  if (amplifier != 0) {
    word = *amplifier;
    if (((word & SERVO_CHANNEL_STATUS_FAULT_MASK) != 0u) == f->fault_is_high) return true;
  }
  if (direction == 0 || limits == 0) return false;
  if (limits != amplifier) word = *limits;
  return (word & (direction > 0 ? SERVO_CHANNEL_STATUS_PLIM_MASK : SERVO_CHANNEL_STATUS_MLIM_MASK)) != 0u;
}

bool motor_flags_positive_limit(uint32_t motor) { return limit(motor, SERVO_CHANNEL_STATUS_PLIM_MASK); }
bool motor_flags_negative_limit(uint32_t motor) { return limit(motor, SERVO_CHANNEL_STATUS_MLIM_MASK); }
