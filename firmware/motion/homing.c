#include "firmware/motion/homing.h"

#include "firmware/motion/jog.h"

bool homing_begin(uint32_t motor) { return jog_home(motor, 0.0, 0); }
void homing_here(uint32_t motor) { jog_set_homed(motor, true); }
bool homing_is_over(uint32_t motor) { return !jog_is_moving(motor); }
