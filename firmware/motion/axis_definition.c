/* Axis definitions of the motors: stored and counted. Commands make and report them (command/axis_commands.c). */
#include "firmware/motion/axis_definition.h"

#include "firmware/base/dimensions.h"
#include "firmware/hal/hal.h"

struct axis_definition axis_definitions[MOTORS];

void axis_definition_initialize(void) {
  for (uint32_t motor = 0; motor < MOTORS; motor++) axis_definitions[motor] = (struct axis_definition){0};
}

void axis_define(uint32_t motor, const struct axis_definition* definition) {
  const uint32_t state = hal_mask_real_time();
  axis_definitions[motor] = *definition;
  hal_unmask(state);
}

uint32_t axis_definition_motors(uint32_t cs) {
  uint32_t count = 0;
  for (uint32_t motor = 0; motor < MOTORS; motor++)
    if (axis_definitions[motor].assigned && axis_definitions[motor].cs == cs) count++;
  return count;
}
