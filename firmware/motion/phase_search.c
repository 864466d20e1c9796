#include "firmware/motion/phase_search.h"

#include "firmware/motion/phasing.h"

bool phasing_begin(uint32_t motor) { return !phasing_is_missing(motor); }
void phasing_power_on(void) {}
void phasing_servo(uint32_t motor) { (void)motor; }
void phasing_pass(void) {}
void phasing_set_here(uint32_t motor) { (void)motor; }
