#include "firmware/motion/position_loop.h"

#include "firmware/motion/motor.h"

void position_loop_motor_changed(uint32_t motor) { (void)motor; }
void position_loop_servo(uint32_t motor) { (void)motor; }
void position_loop_restart(uint32_t motor) { (void)motor; }

uint32_t position_loop_reading(uint32_t motor) { return (void)motor, 0; }
void position_loop_shift(uint32_t motor, int64_t by) { motors[motor].actual += by; }
void position_loop_forget_movement(uint32_t motor) { (void)motor; }
