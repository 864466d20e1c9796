#include "firmware/host/dpram_functions.h"

#include <stdbool.h>

#include "firmware/host/dpram_ascii.h"
#include "firmware/host/dpram_motors.h"
#include "firmware/host/dpram_systems.h"
#include "firmware/host/dpram_variables.h"
#include "firmware/variables/i_variables.h"

/* Not 0: there is something to look at. Cleared before it is done, so that a change meanwhile is not lost. */
static volatile uint32_t background_looks, servo_looks;

void dpram_functions_changed(uint32_t instance) {
  (void)instance;
  background_looks = servo_looks = 1;
}

void dpram_functions_initialize(void) {
  dpram_ascii_initialize();
  dpram_motors_initialize();
  dpram_systems_initialize();
  dpram_variables_initialize();
  dpram_functions_changed(0);
}

static bool any_in_background(void) {
  return (i_integer(I49_DPRAM_BACKGROUND_ENABLE) | i_integer(I55_DPRAM_VARIABLES) | i_integer(I57_DPRAM_MOTORS_ENABLE) |
          i_integer(I58_DPRAM_ASCII)) != 0;
}

void dpram_functions_pass(void) {
  if (background_looks == 0u) return;
  background_looks = 0;
  dpram_ascii_pass();
  dpram_motors_pass();
  dpram_systems_pass();
  dpram_variables_pass();
  if (any_in_background()) background_looks = 1;
}

void dpram_functions_servo(void) {
  if (servo_looks == 0u) return;
  servo_looks = 0;
  if (dpram_motors_servo()) servo_looks = 1;
}
