/* What the net desired position of a motor is made by, but for its trajectory, and where that is while its loop is not
 * closed. The servo loop is above it, and above that what makes the position of a closed one (desired_position.h). */
#ifndef FIRMWARE_MOTION_DESIRED_PATH_H
#define FIRMWARE_MOTION_DESIRED_PATH_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/motion/motor.h"

/* Owners: motion/motor.h. */
struct desired_path {
  /* V */
  const volatile uint32_t* master; /* word of Ixx05 */
  bool follows;
  int32_t master_scale;
  uint32_t share;                                       /* 2^32 (1 - Ixx40); 0: no filter */
  int64_t backlash, backlash_rate, backlash_hysteresis; /* position; rate a background pass */
  int64_t error_most;                                   /* Ixx67 where what is beyond it is held back; else 0 */
  /* S */
  uint32_t master_reading;
  uint32_t fraction; /* of the filtered position, 2^-32 */
  int64_t turning;   /* how far the trajectory has come in its direction */
  int64_t taken_up;  /* backlash at present */
  bool down;         /* direction of the last movement */
};

extern struct desired_path desired_paths[MOTORS];

/* 0..31, servo task held off: the trajectory is set so that the motor is commanded to be where it is. */
void desired_path_take_actual(uint32_t motor);
void desired_path_stand(uint32_t motor); /* the same, its tables add what they have added */

/* 0..31, any task: what its tables will add when positions are counted so that it is at `position`, as commands count.
 */
int64_t desired_path_corrections(uint32_t motor, int64_t position);
/* 0..31, background and real-time task: the same, with the servo task held off from then on, so that it is true until
 * hal_unmask(). */
uint32_t desired_path_hold(uint32_t motor, int64_t position, int64_t* corrections);
/* 0..31, background and real-time task, a loop that is not closed: what its tables add where it is, although no servo
 * interrupt has seen them yet. */
void desired_path_look_at_tables(uint32_t motor);

#endif
