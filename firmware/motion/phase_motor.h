/* A commutated motor as the phase task has it: what was resolved from its variables, and its state. Apart from struct
 * motor, so that what is used nine thousand times a second stands together. Formats: motion/fixed_point.h.
 *
 * Owners: V who writes I-variables; S servo task; C who changes the state of the loop; P phase task. The phase task
 * cannot be interrupted by the others: V takes the motor off its list (phase_task_work) before the settings change. */
#ifndef FIRMWARE_MOTION_PHASE_MOTOR_H
#define FIRMWARE_MOTION_PHASE_MOTOR_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/dimensions.h"
#include "firmware/motion/fixed_point.h"

enum { PHASES = 3, MEASURED_PHASES = 2 };

/* V. An address where nothing is leads to a word that reads 0 and is looked at by nobody. */
struct phase_settings {
  const volatile uint32_t* source; /* Ixx83 */
  int32_t multiplier;              /* Ixx70 */
  int32_t cycle, half;             /* Ixx71, and where the position wraps: -half .. cycle - half - 1 */
  uint32_t shift;                  /* angle = (position << shift) * reciprocal, see phase_angle */
  int32_t reciprocal;
  uint32_t table;                    /* first address of the sine table, Ixx55 */
  uint32_t second;                   /* angle of the second phase, Ixx72 */
  volatile uint32_t* output[PHASES]; /* Ixx02 */
  bool current_loop;                 /* Ixx82 is not 0 */
  bool brush;                        /* Ixx96 bit 0 with it: one current */
  bool third_harmonic;               /* Ixx24 bit 10 is 0 */
  bool micro_stepping;               /* Ixx96 bit 0 without it: the output is a frequency */
  int32_t bias[MEASURED_PHASES];     /* Ixx29, Ixx79: 2^-29 of full scale with a current loop, else output */
  const volatile uint32_t* measured[MEASURED_PHASES]; /* Ixx82 and one below it */
  uint32_t mask;                                      /* Ixx84 */
  int32_t integral, proportional, back;               /* 8 Ixx61, 4 Ixx62, 4 Ixx76 */
  int32_t pwm_scale;                                  /* 2^11 Ixx66 */
  /* of the servo task */
  int32_t magnetisation; /* Ixx77, a current */
  int32_t advance_gain;  /* Ixx56: 2^-37 of 1/2048 cycle a unit of velocity */
  int32_t slip_gain;     /* Ixx78: 2^-40 of a unit of the phase position, each phase update, a unit of output */
};

struct phase_axis {
  volatile int32_t command; /* S: current */
  int32_t actual;           /* P: current as it was measured */
  int32_t integrator;       /* P: voltage. C zeroes it */
};

struct phase_motor {
  struct phase_settings settings;
  struct phase_axis q, d;
  volatile bool enabled;        /* C */
  volatile bool searched;       /* C: its phase reference is; the servo loop commands nothing */
  volatile bool held;           /* S, C: by a phase search: the angle is `advance` */
  volatile uint32_t advance;    /* S: angle, added to that of the phase position */
  volatile int32_t step;        /* S: what the phase position moves by itself each time: whole units, ... */
  volatile uint32_t step_parts; /* ... and 2^-24 of them */
};

extern struct phase_motor phase_motors[MOTORS];

/* From the variables of motor 1..32. */
struct phase_settings phase_motor_resolve(uint32_t motor);

/* Angle of a phase position that is inside the cycle, at most 2^-29 of it too large. */
static inline uint32_t phase_angle(const struct phase_settings* s, int32_t position) {
  const int32_t part = (int32_t)((uint32_t)position << s->shift);
  return ((uint32_t)fixed_high(part, s->reciprocal) + 1u) << 2;
}

#endif
