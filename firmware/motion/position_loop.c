#include "firmware/motion/position_loop.h"

void position_loop_motor_changed(uint32_t motor) { (void)motor; }
void position_loop_servo(uint32_t motor) { (void)motor; }
void position_loop_restart(uint32_t motor) { (void)motor; }
