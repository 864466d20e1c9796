/* Axis definitions `#n->...` (firmware:7.4): which axes of which coordinate system a motor carries, and its scale. */
#ifndef FIRMWARE_MOTION_AXIS_DEFINITION_H
#define FIRMWARE_MOTION_AXIS_DEFINITION_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/dimensions.h"
#include "firmware/language/word.h"

struct axis_definition {
  bool assigned, kinematic; /* `I`: inverse kinematics */
  uint32_t cs;
  double scale[AXIS_COUNT]; /* counts a user unit */
  double offset;            /* counts */
};

/* Background; part of the SAVE image. Programs read them too (motion/live_words.c), in the real-time task, so that it
 * is held off while one changes. */
extern struct axis_definition axis_definitions[MOTORS];
extern uint32_t axis_motors[COORDINATE_SYSTEMS]; /* bit n-1: motor n is assigned to it. As those */

void axis_definition_initialize(void); /* none: SAVEd definitions are put back by the start-up */
void axis_define(uint32_t motor, const struct axis_definition* definition);
uint32_t axis_definition_time_base(uint32_t motor); /* whose time the motor goes by: of none, that of &1 */
uint32_t axis_definition_motors(uint32_t cs);       /* motors assigned to it */

#endif
