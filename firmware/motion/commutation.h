/* What the servo task and the state of a motor's loop say to the phase task. Motors are numbered from 0 here. */
#ifndef FIRMWARE_MOTION_COMMUTATION_H
#define FIRMWARE_MOTION_COMMUTATION_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/motion/fixed_point.h"
#include "firmware/motion/phase_motor.h"
#include "firmware/motion/phase_task.h"

enum { COMMUTATION_TO_CURRENT = CURRENT_FRACTION_BITS - 15 - OUTPUT_FRACTION_BITS };

/* Whether the phase task puts out what the motor's loop commands: Ixx00 = 1 and Ixx01 bit 0 = 1. Any task. */
static inline bool commutation_is_used(uint32_t motor) { return ((phase_task_work >> motor) & 1u) != 0u; }

/* Servo task, each servo interrupt: the output of the loop, in 2^-8 of a 16-bit output (fixed_point.h), is the torque
 * command Iq; with direct micro-stepping it is a frequency. Without effect while a phase reference is searched. */
void commutation_command(uint32_t motor, int32_t output);

/* Who changes the state of the loop, the servo task held off. Off: no current is commanded, the integrators of the
 * current loop are zero, a search for a phase reference has failed; the biases stay where there is no current loop. */
void commutation_enable(uint32_t motor, bool enabled);

/* Iq and Id in 2^-8 of a 16-bit output: measured where the current loop is closed, else commanded. Any task. */
struct motor_current {
  int32_t q, d;
};
static inline struct motor_current commutation_current(uint32_t motor) {
  const struct phase_motor* p = &phase_motors[motor];
  const bool is_measured = p->settings.current_loop;
  const int32_t q = is_measured ? p->q.actual : p->q.command, d = is_measured ? p->d.actual : p->d.command;
  return (struct motor_current){q >> COMMUTATION_TO_CURRENT, d >> COMMUTATION_TO_CURRENT};
}

#endif
