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
#include "firmware/motion/own_path.h"
#include "firmware/motion/speed_profile.h"

enum jog_aim { AIM_SPEED, AIM_REST, AIM_TARGET, AIM_RAMP };

struct jog_motion {
  enum jog_aim aim;
  bool searches, homes; /* for a trigger; which becomes home */
  bool by_program;      /* held with its coordinate system */
  uint32_t together;    /* motors that begin at the same interrupt, at rest until then; 0: it alone */
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
  volatile bool ready; /* R: `next` and its path are complete; S: it is on it */
  uint32_t current;    /* S: of the paths */
  int64_t next_begins;
  struct jog_motion now, next, request; /* S; R; Q */
  struct own_path paths[2];
  volatile uint32_t requests; /* so far, whatever makes R plan anew */
  int64_t request_begins;     /* earliest clock */
  int64_t delay;              /* Ixx92, of the last request */
  bool away;                  /* from `before`, by anything but a program. Q, S */
  int64_t before;
};

extern struct jog jogs[MOTORS];
/* A bit a motor: S has something to do, R has. Changed with the servo task held off, and by it. */
extern volatile uint32_t jogs_busy, jogs_asked;

static inline uint32_t jog_bit(uint32_t motor) { return 1u << motor; }
int32_t jog_rate_of(uint32_t motor, bool by_program);            /* trajectory time a servo cycle, 0 or more */
bool jog_by_program(const struct jog* j);                        /* what it does, at rest what it waits for */
void jog_post(uint32_t motor, const struct jog_motion* request); /* servo task held off, or in it */

#endif
