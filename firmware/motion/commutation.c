/* The servo task's side of commutation: commands, the angle that the delay from measurement to output takes (Ixx56),
 * slip of induction motors (Ixx78), and the frequency of micro-steps. */
#include "firmware/motion/commutation.h"

#include "firmware/hal/hal.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/phase_motor.h"
#include "firmware/motion/phase_task.h"

enum { TO_CURRENT = CURRENT_FRACTION_BITS - 15 - OUTPUT_FRACTION_BITS };
enum { ADVANCE_SHIFT = 16, SLIP_SHIFT = 16 }; /* 2^-48 of a cycle to an angle; 2^-40 to 2^-24 of a unit */
enum { PART_BITS = 24 };                      /* of the phase position's fraction */

bool commutation_is_used(uint32_t motor) { return ((phase_task_work >> motor) & 1u) != 0u; }

/* The phase task finds both parts of one step. */
static void set_step(struct phase_motor* p, int32_t whole, uint32_t parts) {
  if (whole == p->step && parts == p->step_parts) return;
  const uint32_t state = hal_mask_all();
  p->step = whole;
  p->step_parts = parts;
  hal_unmask(state);
}

/* `step` in 2^-24 of a unit, at most 2^22 units. */
static void set_long_step(struct phase_motor* p, int64_t step) {
  const int64_t longest = (int64_t)1 << (PART_BITS + 22);
  if (step > longest) step = longest;
  if (step < -longest) step = -longest;
  set_step(p, (int32_t)(step >> PART_BITS), (uint32_t)step & HAL_WORD_MASK);
}

void commutation_command(uint32_t motor, int32_t output) {
  struct phase_motor* p = &phase_motors[motor];
  const struct phase_settings* s = &p->settings;
  if (!p->enabled || p->searched) return;
  p->d.command = s->magnetisation;
  if (s->micro_stepping) {
    const int64_t step = (int64_t)output * s->multiplier;
    p->q.command = 0;
    set_long_step(p, step * (1 << (PART_BITS - OUTPUT_FRACTION_BITS)));
    return;
  }
  p->q.command = output * (1 << TO_CURRENT);
  set_long_step(p, (int64_t)output * s->slip_gain >> SLIP_SHIFT);
  p->advance = (uint32_t)((int64_t)motors[motor].velocity * s->advance_gain >> ADVANCE_SHIFT);
}

void commutation_enable(uint32_t motor, bool enabled) {
  struct phase_motor* p = &phase_motors[motor];
  const uint32_t state = hal_mask_all();
  p->enabled = enabled;
  p->held = p->searched = false;
  p->advance = 0;
  p->step = 0;
  p->step_parts = 0;
  p->q.command = p->q.integrator = p->d.integrator = 0;
  p->d.command = enabled ? p->settings.magnetisation : 0;
  hal_unmask(state);
}

struct motor_current commutation_current(uint32_t motor) {
  const struct phase_motor* p = &phase_motors[motor];
  const bool is_measured = p->settings.current_loop;
  const int32_t q = is_measured ? p->q.actual : p->q.command, d = is_measured ? p->d.actual : p->d.command;
  return (struct motor_current){q >> TO_CURRENT, d >> TO_CURRENT};
}
