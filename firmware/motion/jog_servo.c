/* Time is that of the motor's coordinate system, counted while there is something to do. */
#include "firmware/motion/jog_servo.h"

#include <stdbool.h>

#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/desired_path.h"
#include "firmware/motion/jog.h"
#include "firmware/motion/jog_state.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/position_loop.h"

/* Onto another time base no faster than the system itself may change: what is not held follows it at once. */
static int32_t approach(int32_t present, int32_t target, int32_t slew) {
  if (present < target) return target - present > slew ? present + slew : target;
  return present - target > slew ? present - slew : target;
}

static bool searches_without_end(const struct jog_motion* motion) { return motion->aim == AIM_SPEED; }

/* The new path begins where the old one is, planned for this moment. */
static inline void change_over(struct jog* j, struct motor* m) {
  const struct jog_motion* next = jog_next(j);
  j->current ^= 1u;
  j->ready = false;
  m->path = PATH_OWN;
  m->status.timed_move = !searches_without_end(next);
  m->status.aborting = next->aim == AIM_RAMP;
  m->status.home_search = next->searches;
  if (next->searches) capture_arm(&next->capture);
}

/* Off the path of a system, whose time may have changed since it was planned, it begins where the motor is now. At a
 * rate of its own it makes that of the interrupt at this rate. */
static __attribute__((noinline)) int32_t ramp_begins(uint32_t motor, int32_t since) {
  struct jog* j = &jogs[motor];
  struct motor* m = &motors[motor];
  const int32_t before = j->rate, rate = jog_next(j)->rate;
  int32_t elapsed = since;
  if (m->path == PATH_SYSTEM) {
    struct own_path* path = &j->paths[j->current ^ 1u];
    path->shift = m->trajectory - path->start;
    elapsed = 0;
  }
  change_over(j, m);
  if (rate == 0) return elapsed;
  j->rate = rate;
  return before == 0 ? elapsed : (int32_t)((int64_t)elapsed * rate / before);
}

static void found(uint32_t motor, int64_t position) {
  struct jog* j = &jogs[motor];
  struct motor_status_flags* status = &motors[motor].status;
  struct jog_motion then = *jog_now(j);
  const bool homes = then.homes;
  jog_now(j)->searches = false;
  status->home_search = false;
  then.aim = AIM_TARGET;
  then.searches = false;
  then.triggered = !homes;
  then.anew = true;
  then.together = 0;
  then.target = jog_trajectory_at(motor, position) + then.beyond;
  if (homes) {
    const int64_t followed = motor_followed(motor);
    /* where the trigger was */
    jog_count_from(motor, then.target + followed, desired_path_corrections(motor, -then.beyond));
    position_loop_show(motor);
    then.target = -followed;
    j->before = 0;
    status->home_complete = true;
  }
  if (j->ready || (jogs_asked & jog_bit(motor)) != 0u) { /* something else has been asked for */
    status->trigger_move = jog_is_trigger_move(&j->request);
    return;
  }
  then.homes = false;
  jog_post(motor, &then);
}

/* A move of its system has come to its end for this motor, for others it may go on; what no program of its own system
 * has moved is away from there. */
static void arrives(struct motor* m) {
  if (coordinate_systems[m->cs].active) m->of_system = m->trajectory;
}

static __attribute__((noinline)) void over(uint32_t motor) {
  struct jog* j = &jogs[motor];
  struct motor_status_flags* status = &motors[motor].status;
  motors[motor].path = PATH_STANDS;
  if (jog_now(j)->by_program) arrives(&motors[motor]);
  const bool triggered = jog_now(j)->triggered;
  status->timed_move = status->aborting = status->home_search = false;
  jog_rests(j);
  if (j->ready || (jogs_asked & jog_bit(motor)) != 0u) return;
  if (triggered) status->trigger_move = false;
  jogs_busy &= ~jog_bit(motor);
}

/* What only few interrupts have to do stands apart: the rest is quicker without. */
static __attribute__((noinline)) void search(uint32_t motor) {
  int64_t position;
  if (capture_servo(motor, &jog_now(&jogs[motor])->capture, &position)) found(motor, position);
}

/* A ramp ends as it begins: no change of the time base makes it slower, or quicker than the motor was. Who has gone at
 * the rate of the system goes on at that, whatever slews it; so does what leaves its path, in place of a ramp that has
 * not begun, until it has. */
static __attribute__((noinline)) int32_t other_rate(uint32_t motor, int32_t target) {
  const struct coordinate_system* s = &coordinate_systems[motors[motor].cs];
  const int32_t rate = jogs[motor].rate;
  if (jog_now(&jogs[motor])->aim == AIM_RAMP) return rate;
  if (motors[motor].path == PATH_SYSTEM && s->increment != 0) return s->increment;
  return rate == s->increment_before && target == s->increment ? target : approach(rate, target, s->increment_slew);
}

/* What of this interrupt belongs to the new path; below 0: it has not begun. */
static __attribute__((noinline)) int32_t begins(uint32_t motor) {
  struct jog* j = &jogs[motor];
  struct motor* m = &motors[motor];
  FIXED_IN_REGISTER(j);
  FIXED_IN_REGISTER(m);
  const int64_t since = j->clock - j->next_begins;
  if (since < 0) {
    if (j->rate == 0 && jog_next(j)->aim == AIM_RAMP) jog_drop(motor); /* its time does not come: on the spot */
    return -1;
  }
  if (jog_next(j)->aim == AIM_RAMP) return ramp_begins(motor, (int32_t)since);
  change_over(j, m);
  return (int32_t)since;
}

void jog_move(uint32_t motor) {
  struct jog* j = &jogs[motor];
  struct motor* m = &motors[motor];
  FIXED_IN_REGISTER(j);
  FIXED_IN_REGISTER(m);
  const struct coordinate_system* s = &coordinate_systems[m->cs];
  FIXED_IN_REGISTER(s);
  const int32_t target = s->held ? jog_rate_of(m, jog_present(j)->by_program) : s->increment;
  if (m->loop != LOOP_CLOSED) {
    jog_drop(motor);
    return;
  }
  if (j->rate != target) j->rate = other_rate(motor, target);
  int32_t elapsed = j->rate;
  j->clock += elapsed;
  const int32_t since = j->ready ? begins(motor) : -1;
  if (since >= 0)
    elapsed = since;
  else if (m->path != PATH_OWN) /* a program moves it still, or nobody */
    return;
  const bool goes_on = own_path_advance(&j->paths[j->current], elapsed, &m->trajectory);
  if (m->status.home_search) search(motor);
  if (!goes_on) over(motor);
}
