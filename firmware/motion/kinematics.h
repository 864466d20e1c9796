/* Kinematics (motion:8.1): where the motors of a coordinate system that are defined by `I` are, by its inverse program,
 * and where its axes are, by the forward program. Positions as in motion/system_motors.h, the bias of the motor in
 * them. Real-time task, in slices. docs/kinematics.md */
#ifndef FIRMWARE_MOTION_KINEMATICS_H
#define FIRMWARE_MOTION_KINEMATICS_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/error.h"
#include "firmware/buffers/fixed_programs.h"
#include "firmware/motion/coordinate_system.h"

/* Executes FIXED_FORWARD or FIXED_INVERSE of the system to its end; NONE, or why it cannot be. image/tables.c */
extern enum run_time_error (*const kinematics_execute)(uint32_t cs, enum fixed_kind kind);

/* The motors that the inverse program moves, from those in `by_program`; none unless Isx50 = 1. What was solved is
 * forgotten. Background too. */
uint32_t kinematics_resolve(uint32_t cs, uint32_t by_program);

/* The axes are where the motors are commanded to be. False: the program has failed (coordinate_system.failure). */
bool kinematics_forward(uint32_t cs, double position[AXIS_COUNT]);
/* At `position` the motors are where they are commanded to be now: nothing is executed for that. */
void kinematics_stand(uint32_t cs, const double position[AXIS_COUNT]);
/* Where they are with axes at `position`; what was asked for last is not executed again. False: it has failed, and
 * nothing of it counts. */
bool kinematics_inverse(uint32_t cs, const double position[AXIS_COUNT]);
/* The same of a PVT move, where the program tells velocities too, a ms. */
bool kinematics_inverse_knot(uint32_t cs, const struct knot* knot);
double kinematics_at(uint32_t motor);
double kinematics_velocity(uint32_t motor); /* behind the last kinematics_inverse_knot */

#endif
