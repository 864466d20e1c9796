/* The motors of a coordinate system, for whoever plans its moves: where axes put them, what the planned moves ask of
 * them, and the way back from motors to axes. Positions are those of motion/fixed_point.h, as doubles before they are
 * rounded. Real-time task, in slices; it is resolved at the start of a program, which holds definitions as they are. */
#ifndef FIRMWARE_MOTION_SYSTEM_MOTORS_H
#define FIRMWARE_MOTION_SYSTEM_MOTORS_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/dimensions.h"
#include "firmware/motion/coordinate_system.h"

/* What a move asks of a motor: the corners at which it begins and ends, the velocity between them a ms. */
struct motor_move {
  double from, to, velocity;
};

/* As coordinate_system.moves: [0] and [1] belong to the moves of the same number. */
extern struct motor_move motor_moves[2][MOTORS];

void system_motors_resolve(uint32_t cs); /* its motors, scales and offsets; background too */
/* Before system_motor_at and system_motor_from of any of them for this position, and system_motor_velocity_at: motors
 * that an inverse program moves have it executed. That can fail: coordinate_system.failure, the position counts for
 * nothing then. */
void system_motors_solve(uint32_t cs, const double position[AXIS_COUNT]);
double system_motor_solved(uint32_t motor); /* behind it, of one that an inverse program moves */
void system_motors_solve_knot(uint32_t cs, const struct knot* knot);
double system_motor_at(uint32_t motor, const double position[AXIS_COUNT]);
/* The same where a move begins: the first of a program takes motors along that stand beside their axes, because others
 * tell where those are. Once it is placed they do not. */
double system_motor_from(uint32_t motor, const double position[AXIS_COUNT]);
double system_motor_aside(uint32_t motor); /* by which they differ */
void system_motors_come_along(uint32_t cs);
void system_motor_stands_aside(uint32_t motor, int64_t by); /* a limit has held it */
/* Where an absolute move of a rotary axis from `from` goes that is told to go to `target` (motion/rollover.h); others
 * as told. */
double system_motors_turn(uint32_t cs, uint32_t axis, double from, double target);
double system_motor_velocity_at(uint32_t motor, const double velocity[AXIS_COUNT]);
uint32_t system_motor_axes(uint32_t motor); /* those that move it */
double system_motor_counts(uint32_t motor, int64_t distance);
/* Of distances behind a trigger those of its axes in `axes`; false: it has none of them. */
bool system_motor_behind(uint32_t motor, uint32_t axes, const double distance[AXIS_COUNT], int64_t* behind);
/* Axes are where motors are commanded to be; exact if they were, but for what a forward program tells. False: that one
 * has failed (coordinate_system.failure). */
bool system_motors_match(uint32_t cs);
void system_motors_begin(uint32_t cs); /* the same, and the program moves them from now on */
bool system_motors_leave(
    uint32_t cs); /* after an abort: some are still on its path or a move of their own, about to leave it */
bool system_motors_are_away(uint32_t cs); /* not where the program has left them */
void system_motors_take(uint32_t cs);     /* the program goes on with them: they have been jogged and are back */

/* The system that moves a motor by RAPID or HOME, be the motor its own, another's or nobody's; COORDINATE_SYSTEMS:
 * none. Of two it is that of the motor. Any task. */
uint32_t system_motor_mover(uint32_t motor);
/* An abort: those of closed loops leave its path, to rest at Ixx15, and so do others that it moves. Any task. */
void system_motors_ramp(uint32_t cs);
/* Bit n: motor n is one that it moves so, or is about to. Servo task held off. */
uint32_t system_motors_alone(uint32_t cs);
/* Behind a ramp, of those when the moves were dropped: what the real-time task has begun in between. */
void system_motors_ramp_rest(uint32_t cs, uint32_t of);
/* PSET, at rest: the axes in `axes` are at `position` from now on, by the bias of the motors. */
void system_motors_set_position(uint32_t cs, uint32_t axes, const double position[AXIS_COUNT]);

/* Limits of a motor for moves, position a ms and ms^2; 0: none. */
double system_motor_velocity(uint32_t motor);     /* Ixx16 */
double system_motor_acceleration(uint32_t motor); /* Ixx17 */

#endif
