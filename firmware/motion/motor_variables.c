#include "firmware/motion/motor_variables.h"

#include "firmware/base/rework.h"
#include "firmware/hal/hal.h"
#include "firmware/motion/average_velocity.h"
#include "firmware/motion/axis_definition.h"
#include "firmware/motion/compensation.h"
#include "firmware/motion/conversion_table.h"
#include "firmware/motion/desired_position.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/motor_flags.h"
#include "firmware/motion/motor_output.h"
#include "firmware/motion/position_loop.h"
#include "firmware/motion/protection.h"
#include "firmware/motion/servo_words.h"
#include "firmware/variables/i_variables.h"

static struct rework rework; /* bit n-1: motor n */

static void take_scales(uint32_t motor) {
  struct motor* m = &motors[motor - 1u];
  const int32_t position = i_integer(i_motor(motor, IXX08_POSITION_SCALE)), before = m->position_scale;
  m->position_scale = position > 0 ? position : 1;
  m->velocity_scale = i_integer(i_motor(motor, IXX09_VELOCITY_SCALE));
  if (before != 0 && m->position_scale != before) compensation_changed(); /* its unit */
}

/* A motor that is no longer activated is killed first: nobody would do it afterwards. */
static void take_activated(uint32_t motor) {
  const uint32_t bit = 1u << (motor - 1u);
  if (i_integer(i_motor(motor, IXX00_ACTIVATED)) != 0) {
    const uint32_t state = hal_mask_servo();
    if ((motors_active & bit) == 0u) average_velocity_restart(motor - 1u);
    motors_active |= bit;
    hal_unmask(state);
  } else if ((motors_active & bit) != 0u) {
    protection_kill(motor - 1u);
    motors_active &= ~bit;
  }
}

/* Each module holds the servo task off while it changes what that works with. */
static void change(uint32_t motor) {
  take_scales(motor);
  servo_words_motor_changed(motor);
  desired_position_motor_changed(motor);
  position_loop_motor_changed(motor);
  motor_output_motor_changed(motor);
  motor_flags_motor_changed(motor);
  protection_motor_changed(motor);
  take_activated(motor);
}

void motor_variables_changed(uint32_t motor) {
  uint32_t left = 1u << (motor - 1u);
  if (!rework_begin(&rework, left)) return;
  do {
    for (uint32_t each = 1; each <= MOTORS; ++each)
      if ((left >> (each - 1u) & 1u) != 0u) change(each);
    left = rework_end(&rework);
  } while (left != 0u);
}

void motor_variables_initialize(void) {
  rework = (struct rework){.under_way = false};
  motors_active = motors_enabled = 0;
  __builtin_memset(motors, 0, sizeof motors);
  conversion_table_initialize();
  desired_position_initialize();
  position_loop_initialize();
  motor_output_initialize();
  motor_flags_initialize();
  protection_initialize();
  average_velocity_initialize();
  compensation_initialize();
  conversion_table_servo(); /* where encoders stand now is position 0 */
  for (uint32_t motor = 1; motor <= MOTORS; ++motor) {
    motors[motor - 1u].cs = axis_definition_time_base(motor - 1u);
    if (i_integer(i_motor(motor, IXX00_ACTIVATED)) != 0) {
      motor_variables_changed(motor);
    } else { /* the first variable that is written makes the rest: a start has 25 ms */
      take_scales(motor);
      servo_words_motor_changed(motor);
      position_loop_begin(motor);
    }
  }
}
