#include "firmware/motion/motor_output.h"

void motor_output_motor_changed(uint32_t motor) { (void)motor; }
void motor_output_servo(uint32_t motor) { (void)motor; }
