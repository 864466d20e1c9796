/* The servo task's side of commutation: commands, the angle that the delay from measurement to output takes (Ixx56),
 * slip of induction motors (Ixx78), and the frequency of micro-steps. */
#include "firmware/motion/commutation.h"

#include "firmware/hal/hal.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/motor.h"

enum { ADVANCE_SHIFT = 16, SLIP_SHIFT = 16 }; /* 2^-48 of a cycle to an angle; 2^-40 to 2^-24 of a unit */
enum { PART_BITS = 24 };                      /* of the phase position's fraction */

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
  step = fixed_within_long(step, longest);
  set_step(p, (int32_t)(step >> PART_BITS), (uint32_t)step & HAL_WORD_MASK);
}

/* Of micro-steps, and of slip. */
static __attribute__((noinline)) void turn(struct phase_motor* p, int32_t output) {
  const struct phase_settings* s = &p->settings;
  if (s->micro_stepping)
    set_long_step(p, (int64_t)output * s->multiplier * (1 << (PART_BITS - OUTPUT_FRACTION_BITS)));
  else
    set_long_step(p, (int64_t)output * s->slip_gain >> SLIP_SHIFT);
}

/* The call is the last thing, so that what does not need it saves no registers. */
void commutation_command(uint32_t motor, int32_t output) {
  struct phase_motor* p = &phase_motors[motor];
  const struct phase_settings* s = &p->settings;
  if (!p->enabled || p->searched) return;
  p->d.command = s->magnetisation;
  p->q.command = s->micro_stepping ? 0 : output * (1 << COMMUTATION_TO_CURRENT);
  if (!s->micro_stepping) p->advance = (uint32_t)((int64_t)motors[motor].velocity * s->advance_gain >> ADVANCE_SHIFT);
  if (s->micro_stepping || s->slip_gain != 0 || p->step != 0 || p->step_parts != 0u) turn(p, output);
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
