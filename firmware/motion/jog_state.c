#include "firmware/motion/jog_state.h"

struct jog jogs[MOTORS];
volatile uint32_t jogs_asked;
volatile uint32_t jogs_waiting;

void jog_not_ready(uint32_t motor) {
  jogs[motor].ready = false;
  jogs_waiting &= ~jog_bit(motor);
}

void jog_rests(struct jog* j) {
  struct jog_motion* now = jog_now(j);
  now->aim = AIM_REST;
  now->searches = now->homes = now->triggered = false;
}

bool jog_is_triggered(uint32_t motor) {
  struct jog* j = &jogs[motor];
  const bool waits = j->ready || (jogs_asked & jog_bit(motor)) != 0u;
  return jog_now(j)->triggered || (waits && j->request.triggered);
}

void jog_post(uint32_t motor, const struct jog_motion* request) {
  struct jog* j = &jogs[motor];
  struct motor_status_flags* status = &motors[motor].status;
  if ((jogs_busy & jog_bit(motor)) == 0u) j->rate = jog_rate_of(&motors[motor], request->by_program);
  j->request = *request;
  j->request_begins = j->clock + j->delay;
  j->requests++;
  const bool stops = request->aim == AIM_REST || request->aim == AIM_RAMP;
  if (!stops || jog_is_triggered(motor))
    status->trigger_move = jog_is_trigger_move(request); /* else it has found none */
  if (request->homes) status->home_complete = false;
  jogs_busy |= jog_bit(motor);
  jogs_asked |= jog_bit(motor);
}
