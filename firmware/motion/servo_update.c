/* The order of a servo interrupt: what is measured, where the programs are, then motor by motor where it shall be, and
 * its loop. */
#include "firmware/motion/servo_update.h"

#include "firmware/motion/conversion_table.h"
#include "firmware/motion/motor_servo.h"
#include "firmware/motion/system_path.h"

void servo_update(void) {
  conversion_table_servo();
  system_path_servo();
  motors_servo();
}
