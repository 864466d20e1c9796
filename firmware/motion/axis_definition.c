/* Axis definitions of the motors: stored and counted. Commands make and report them (command/axis_commands.c). */
#include "firmware/motion/axis_definition.h"

#include "firmware/base/dimensions.h"
#include "firmware/hal/hal.h"
#include "firmware/motion/motor.h"

struct axis_definition axis_definitions[MOTORS];
uint32_t axis_motors[COORDINATE_SYSTEMS];

void axis_definition_initialize(void) {
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++) axis_motors[cs] = 0;
  for (uint32_t motor = 0; motor < MOTORS; motor++) axis_definitions[motor] = (struct axis_definition){0};
}

void axis_define(uint32_t motor, const struct axis_definition* definition) {
  const uint32_t state = hal_mask_real_time(), bit = 1u << motor;
  if (axis_definitions[motor].assigned) axis_motors[axis_definitions[motor].cs] &= ~bit;
  axis_definitions[motor] = *definition;
  if (definition->assigned) axis_motors[definition->cs] |= bit;
  motors[motor].cs = axis_definition_time_base(motor);
  hal_unmask(state);
}

uint32_t axis_definition_time_base(uint32_t motor) {
  return axis_definitions[motor].assigned ? axis_definitions[motor].cs : 0u;
}

uint32_t axis_definition_motors(uint32_t cs) {
  uint32_t count = 0;
  for (uint32_t left = axis_motors[cs]; left != 0u; left &= left - 1u) count++;
  return count;
}
