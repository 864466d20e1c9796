/* Following error, limits, faults, overload, in position (motion:6): looked at in each real-time interrupt that is due,
 * before programs are calculated, so that nothing a host or a PLC asks for comes before it. Where those are rare (I8),
 * the servo task looks at a quarter of the motors in turn, and asks for one when something is to be done. */
#ifndef FIRMWARE_MOTION_PROTECTION_H
#define FIRMWARE_MOTION_PROTECTION_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/motion/overload.h"
#include "firmware/variables/i_variables.h"

/* What a trip needs of higher layers; image/tables.c fills it in. */
struct protection_hooks {
  void (*abort)(uint32_t cs); /* the program of a coordinate system and all its motors */
};
extern const struct protection_hooks protection_hooks;

void protection_initialize(void);
void protection_motor_changed(uint32_t motor); /* 1..32: a variable of it was written */
void protection_pass(void);                    /* real-time task: all motors */
bool protection_is_asked_for(void);            /* real-time task: the servo task has seen what does not wait */
void protection_stand(bool still);             /* background: nothing is looked at (SAVE) */
/* Motor 0..31, killed by a variable of it: the program of its system ends with the next pass, and one that homes it. */
void protection_kill(uint32_t motor);
/* The program of a coordinate system begins: what is still to be done is about others. Servo task held off. */
void protection_begin(uint32_t cs);
/* Motor 0..31, servo task held off: whether it stands in a limit of that side, as it is now. Software limits count for
 * no search for home. */
bool protection_is_in_limit(uint32_t motor, bool up, bool homes);
/* The same: a program asks for more of it. The one that does is aborted with the next pass. */
void protection_refuse(uint32_t motor);

extern uint32_t protection_watched;                 /* S; bit n: the servo task looks at motor n in this interrupt */
extern volatile uint32_t protection_always_watched; /* R; in each, as the last pass has left it */
enum { PROTECTION_TURNS = 4 };                      /* servo interrupts in which all motors are looked at */
static inline bool protection_takes_turns(void) { return i_integer(I8_REAL_TIME_PERIOD) >= PROTECTION_TURNS; }
void protection_take_turn(void);
void protection_look(uint32_t motor);
static inline void protection_begin_servo(void) { /* once an interrupt, before protection_servo */
  if (protection_takes_turns())
    protection_take_turn();
  else
    protection_watched = protection_always_watched;
}
static inline void protection_servo(
    uint32_t motor) { /* 0..31: overload, in position of the foreground, urgent things */
  if ((overload_watched >> motor & 1u) != 0u) overload_servo(motor);
  if ((protection_watched >> motor & 1u) != 0u) protection_look(motor);
}

/* The limits of its desired position (Ixx24 bit 15); false: it has none. */
bool protection_desired_limits(uint32_t motor, int64_t* lowest, int64_t* highest);

#endif
