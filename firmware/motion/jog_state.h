/* What requests, planning and the servo task of jogs share (motion/jog.h): two paths a motor, the one it is on, and one
 * that the real-time task makes of the last request.
 *
 * Owners: S servo task; R real-time task, planning; Q who asks, any task with the servo task held off. */
#ifndef FIRMWARE_MOTION_JOG_STATE_H
#define FIRMWARE_MOTION_JOG_STATE_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/dimensions.h"
#include "firmware/motion/capture.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/own_path.h"
#include "firmware/motion/speed_profile.h"

enum jog_aim { AIM_SPEED, AIM_REST, AIM_TARGET, AIM_RAMP };

struct jog_motion {
  enum jog_aim aim;
  bool searches, homes; /* for a trigger; which becomes home */
  bool triggered;       /* from a trigger that is not home, to where the move ends */
  bool anew;            /* from any trigger: at speeds as they are now */
  bool by_program;      /* held with its coordinate system */
  uint32_t together;    /* motors that begin at the same interrupt, at rest until then; 0: it alone */
  int32_t rate;         /* of a ramp off what slews to another: from its begin on; 0: that of then */
  double speed;         /* of AIM_SPEED with sign */
  double deceleration;  /* of AIM_RAMP */
  int64_t target;
  int64_t beyond; /* the trigger: where to then */
  struct speed_limits limits;
  struct capture capture;
};

struct jog {
  int64_t clock;       /* S */
  int32_t rate;        /* S: trajectory time a servo cycle */
  volatile bool ready; /* R: the next motion and its path are complete; S: it is on it */
  uint32_t current;    /* S: of motions and paths */
  int64_t next_begins;
  struct jog_motion motions[2]; /* that under way, and of `next`: one is S's and the other R's, as of the paths */
  struct own_path paths[2];
  struct jog_motion request;  /* Q */
  volatile uint32_t requests; /* so far, whatever makes R plan anew */
  int64_t request_begins;     /* earliest clock */
  int64_t delay;              /* Ixx92, of the last request */
  bool away;                  /* from `before`, by anything but a program. Q, S */
  int64_t before;
};

extern struct jog jogs[MOTORS];
/* A bit a motor: R has something to do. Changed with the servo task held off, and by it. */
extern volatile uint32_t jogs_asked;
/* A bit a motor: ready, and to begin with others that are not. Changed as jogs_asked. */
extern volatile uint32_t jogs_waiting;

static inline uint32_t jog_bit(uint32_t motor) { return 1u << motor; }
static inline struct jog_motion* jog_now(struct jog* j) { return &j->motions[j->current]; }
static inline struct jog_motion* jog_next(struct jog* j) { return &j->motions[j->current ^ 1u]; }

/* What it does, at rest what it waits for. */
static inline const struct jog_motion* jog_present(const struct jog* j) {
  const struct jog_motion* now = &j->motions[j->current];
  return now->aim == AIM_REST ? &j->request : now;
}

/* Trajectory time a servo cycle, 0 or more. What no program moves goes on while the system is held: it takes the time
 * base as commanded. */
static inline int32_t jog_rate_of(const struct motor* m, bool by_program) {
  const struct coordinate_system* s = &coordinate_systems[m->cs];
  return s->held && !by_program ? s->increment_command : s->increment;
}

/* Status word 2 bit 7: until a trigger, and on from there. */
static inline bool jog_is_trigger_move(const struct jog_motion* motion) {
  return (motion->searches && !motion->homes) || motion->triggered;
}

bool jog_is_triggered(uint32_t motor);                           /* on the way from a trigger, or about to be */
void jog_not_ready(uint32_t motor);                              /* servo task held off, or in it: nothing is next */
void jog_rests(struct jog* j);                                   /* servo task held off, or in it: at AIM_REST */
void jog_post(uint32_t motor, const struct jog_motion* request); /* the same */

#endif
