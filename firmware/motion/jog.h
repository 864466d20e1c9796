/* Motions of single motors beside any program (motion:4.2 to motion:4.5): jogs, the parts of a homing search,
 * RAPID moves and ramps to rest after an abort. Who wants one leaves a request, whatever task it is; the real-time task
 * plans it, in slices, and hands pieces to the servo task, which goes over to them Ixx92 after the request. Until then
 * the old motion goes on, a motion of the coordinate system too. A request takes the place of one that has not begun.
 *
 * Positions are those of motion/fixed_point.h. Requests: background and real-time task, loop closed. */
#ifndef FIRMWARE_MOTION_JOG_H
#define FIRMWARE_MOTION_JOG_H

#include <stdbool.h>
#include <stdint.h>

struct jog_motion;

/* What requests ask of those who watch motors; image/tables.c fills it in. Servo task held off. */
struct jog_hooks {
  bool (*is_in_limit)(uint32_t motor, bool up, bool homes); /* it stands there: motion/protection.h */
  void (*refuse)(uint32_t motor);                           /* a program asks for more of it */
};
extern const struct jog_hooks jog_hooks;

void jog_initialize(void); /* start-up, before interrupts: nothing moves, no position before a jog but 0 */

/* Requests. False: the loop is not closed, nothing has been asked for. */
bool jog_continuous(uint32_t motor, int direction);               /* J+, J-: Ixx22 without end */
bool jog_stop(uint32_t motor);                                    /* J/ */
bool jog_to(uint32_t motor, int64_t target);                      /* J= */
bool jog_until(uint32_t motor, int64_t target, int64_t distance); /* ^d: to `target`, or `distance` behind a trigger */
/* Those of a program, at rest: the motors in `together` begin at the same servo interrupt. Speed in counts a ms. */
bool jog_rapid(uint32_t motor, int64_t target, double speed, uint32_t together);
bool jog_rapid_until(uint32_t motor, int64_t target, double speed, int64_t distance, uint32_t together);
/* Search at `velocity` (counts a ms, with sign) for a trigger. Where it is, and `offset` further, becomes position 0 at
 * once, and the motor goes there. */
bool jog_home(uint32_t motor, double velocity, int64_t offset, uint32_t together); /* as for RAPID; 0: of none */
/* To rest at a constant deceleration (counts a ms^2), without Ixx92. A motor of a coordinate system leaves its path for
 * that, which has to go on until then: PATH_OWN. */
bool jog_stop_at(uint32_t motor, double deceleration);

/* At once, servo task held off. */
void jog_drop(uint32_t motor);          /* nothing moves it any more: killed, open loop, stopped on the spot */
void jog_program_takes(uint32_t motor); /* a program moves it from now on: PATH_SYSTEM */

/* Real-time task, in slices: behind a trigger, Ixx19 to Ixx23 as they are now. */
void jog_take_speeds(uint32_t motor, struct jog_motion* motion);

/* Any task. More of it stands in the motor's status flags (motion/motor.h). */
bool jog_is_moving(uint32_t motor);     /* on its way, or about to be */
bool jog_is_to_ramp(uint32_t motor);    /* that has been asked for and has not begun */
bool jog_is_of_program(uint32_t motor); /* so, and a program waits for it, held or not */
bool jog_is_homing(uint32_t motor);     /* searches for home: software limits do not count */

/* Where the motor was before it was jogged, killed or opened: the end of what a program or a homing search has moved,
 * or `J==`. */
int64_t jog_position_before(uint32_t motor);
void jog_set_position_before(uint32_t motor, int64_t position);
int64_t jog_commanded(uint32_t motor); /* trajectory position now, of one moment */
void jog_make_whole(uint32_t motor);   /* J!: a motor that stands is commanded to the nearest whole count */
int64_t jog_actual(uint32_t motor);    /* the trajectory position that has it where it is */
/* The trajectory position that has the motor at `actual`. Servo task held off, or in it. */
int64_t jog_trajectory_at(uint32_t motor, int64_t actual);
/* All positions are counted from the present `position`; `corrections` as desired_position_shift. Servo task held off,
 * or in it. */
void jog_count_from(uint32_t motor, int64_t position, int64_t corrections);

#endif
