#include "firmware/motion/phasing.h"

static volatile uint32_t missing_of; /* bit per motor */

void phasing_initialize(void) { missing_of = 0; }
bool phasing_is_missing(uint32_t motor) { return ((missing_of >> motor) & 1u) != 0u; }

bool phasing_is_searched(uint32_t motor) {
  (void)motor;
  return false;
}

void phasing_set_missing(uint32_t motor, bool missing) {
  missing_of = missing ? missing_of | 1u << motor : missing_of & ~(1u << motor);
}
