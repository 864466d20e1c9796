/* A synchronous motor has no reference after a reset, nor when it has only become one: its phase position means nothing
 * yet. Induction motors (Ixx78), direct micro-stepping and brush motors (Ixx96 bit 0) need none. */
#include "firmware/motion/phasing.h"

#include "firmware/base/dimensions.h"
#include "firmware/hal/hal.h"
#include "firmware/variables/i_variables.h"

enum { COMMUTATED = 1, ALTERNATE_MODE = 1 }; /* Ixx01, Ixx96 */

/* Bit n-1 of motor n. Background and real-time task, which is held off meanwhile. */
static volatile uint32_t synchronous_of;
volatile uint32_t phasing_missing, phasing_searched;

static void put(volatile uint32_t* bits, uint32_t motor, bool value) {
  const uint32_t state = hal_mask_real_time();
  *bits = value ? *bits | 1u << motor : *bits & ~(1u << motor);
  hal_unmask(state);
}

static bool has(uint32_t bits, uint32_t motor) { return ((bits >> motor) & 1u) != 0u; }

bool phasing_is_needed(uint32_t motor) { return has(synchronous_of, motor); }
bool phasing_is_missing(uint32_t motor) { return has(phasing_missing, motor); }
bool phasing_is_searched(uint32_t motor) { return has(phasing_searched, motor); }
void phasing_set_missing(uint32_t motor, bool missing) { put(&phasing_missing, motor, missing); }
void phasing_set_searched(uint32_t motor, bool searched) { put(&phasing_searched, motor, searched); }

static bool is_synchronous(uint32_t motor) { /* 1..32 */
  return ((uint32_t)i_integer(i_motor(motor, IXX01_COMMUTATION_ENABLE)) & COMMUTATED) != 0u &&
         ((uint32_t)i_integer(i_motor(motor, IXX96_OUTPUT_MODE)) & ALTERNATE_MODE) == 0u &&
         i_variable_read(I_MOTOR_BLOCK * motor + (uint32_t)IXX78_SLIP_GAIN) == 0.0;
}

void phasing_motor_changed(uint32_t motor) {
  const bool synchronous = is_synchronous(motor);
  const uint32_t state = hal_mask_real_time();
  if (synchronous != has(synchronous_of, motor - 1u)) {
    put(&synchronous_of, motor - 1u, synchronous);
    put(&phasing_missing, motor - 1u, synchronous);
  }
  hal_unmask(state);
}

void phasing_initialize(void) {
  synchronous_of = phasing_missing = phasing_searched = 0;
  for (uint32_t motor = 1; motor <= MOTORS; ++motor) phasing_motor_changed(motor);
}
