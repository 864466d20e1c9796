/* The order of a servo interrupt: what is measured, where the programs are, then motor by motor where it shall be, and
 * its loop. */
#include "firmware/motion/servo_update.h"

#include <stdint.h>

#include "firmware/motion/average_velocity.h"
#include "firmware/motion/conversion_table.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/desired_position.h"
#include "firmware/motion/jog_servo.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/motor_output.h"
#include "firmware/motion/position_loop.h"
#include "firmware/motion/protection.h"
#include "firmware/motion/system_path.h"

static void motor_servo(uint32_t motor) {
  jog_servo(motor);
  desired_position_servo(motor);
  position_loop_servo(motor);
  protection_servo(motor);
  motor_output_servo(motor);
}

void servo_update(void) {
  conversion_table_servo();
  if (cs_busy != 0) system_path_servo();
  protection_begin_servo();
  for (uint32_t motor = 0, left = motors_active; left != 0; motor++, left >>= 1)
    if ((left & 1u) != 0) motor_servo(motor);
  average_velocity_servo();
}
