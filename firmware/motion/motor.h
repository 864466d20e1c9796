/* The 32 motors as the servo task has them: state of the loop, positions, and what was resolved from variables when
 * those were written. Index 0 is motor 1. Formats: motion/fixed_point.h.
 *
 * Owners: S servo task; V who writes I-variables (background and real-time task, the servo task held off); C who
 * changes the state of the loop (motion/motor_state.h, the servo task held off). */
#ifndef FIRMWARE_MOTION_MOTOR_H
#define FIRMWARE_MOTION_MOTOR_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/dimensions.h"

enum motor_loop { LOOP_KILLED, LOOP_OPEN, LOOP_CLOSED };

/* Who says where the motor shall be. */
enum motor_path {
  PATH_STANDS, /* it keeps its trajectory position */
  PATH_OWN,    /* its own ring: jogs, homing, RAPID, ramps (motion/jog.h) */
  PATH_SYSTEM  /* the ring of its coordinate system (motion/coordinate_system.h) */
};

/* What jogs and homing tell the status words (motion/motor_status.h). */
struct motor_status_flags {
  volatile bool timed_move;   /* a move of known length, not a jog that goes on or a search before its trigger */
  volatile bool aborting;     /* the ramp of an abort, Ixx15 */
  volatile bool home_search;  /* for any trigger, until it has come */
  volatile bool trigger_move; /* until a trigger, to its end; stays when none was found */
  volatile bool home_complete;
};

/* What protection has found (motion/protection.h), for the status words. The first four stay until the loop is closed
 * or opened again, the next two until the motor moves on. */
struct motor_findings {
  bool fatal_error, integrated_error, integrated_current, amplifier_fault, on_limit, on_desired_limit;
  bool warning_error, in_position;
  volatile bool positive_limit, negative_limit;     /* an input, or the software limit of that side */
  volatile bool positive_desired, negative_desired; /* the commanded position is beyond that of the desired one */
  volatile bool foreground_in_position;             /* S */
};

struct motor {
  volatile enum motor_loop loop; /* C */
  volatile enum motor_path path; /* who plans, servo task held off; S when a path has ended */
  /* positions, S */
  int64_t trajectory;   /* by its path */
  int64_t commanded;    /* net desired position: with following, compensation, backlash; D:+$08 */
  int64_t closed_at;    /* commanded at the last closure of the loop */
  int64_t actual;       /* D:+$0B */
  int64_t master;       /* position of the master that it follows, D:+$0D */
  int64_t held_back;    /* of the master: following error beyond Ixx67, with Ixx24 bit 13; D:+$0D is without it */
  int64_t compensation; /* by tables and backlash: commanded has it added, what is reported taken off; D:+$10 */
  int64_t bias;         /* D:+$4C: not part of the loop; axis offsets and the like */
  int32_t desired_step; /* net desired position, less that of the last servo interrupt: 0 is "desired velocity zero" */
  int32_t velocity;     /* X:+$1D, raw velocity */
  int64_t matched;      /* R: what it had followed when axes were matched with motors, and has not taken them along */
  int64_t of_system;    /* where its coordinate system has it; by R, then S (motion/system_motors.h) */
  /* outputs, S */
  int32_t open_output; /* C: of a loop that is open, output */
  int32_t output;      /* what the loop commands, before bias and commutation: output */
  /* variables, V */
  int32_t position_scale;           /* Ixx08, at least 1 here */
  int32_t velocity_scale;           /* Ixx09 */
  uint32_t cs;                      /* coordinate system whose time base it moves by; with its axis definition */
  bool origin_follows;              /* Ixx06 bit 1: what commands count from goes with the master */
  struct motor_status_flags status; /* jogs, S or who asks for one, the servo task held off */
  struct motor_findings found;      /* B, but for what is S */
};

extern struct motor motors[MOTORS];
extern volatile uint32_t motors_active;  /* V: bit n-1: Ixx00 of motor n */
extern volatile uint32_t motors_enabled; /* C: bit n-1: motor n is not killed */
/* Bit n-1: the servo task has something to do for a jog of motor n (motion/jog_servo.h). Changed with it held off, and
 * by it. */
extern volatile uint32_t jogs_busy;

/* What positions of commands are ahead of those of the trajectory (motion:1.2/4). Servo task held off, or in it. */
static inline int64_t motor_followed(uint32_t motor) { return motors[motor].origin_follows ? 0 : motors[motor].master; }

/* What axes are ahead of the trajectory. The same. */
static inline int64_t motor_axes_ahead(uint32_t motor) { return motors[motor].bias + motors[motor].matched; }

/* 1/(32 Ixx08) counts of `counts`; rounded to nearest. Floating point. */
int64_t motor_position_of(uint32_t motor, double counts);
double motor_counts_of(uint32_t motor, int64_t position);

#endif
