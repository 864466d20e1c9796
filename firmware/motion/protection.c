#include "firmware/motion/protection.h"

void protection_motor_changed(uint32_t motor) { (void)motor; }
void protection_servo(uint32_t motor) { (void)motor; }
void protection_pass(void) {}
