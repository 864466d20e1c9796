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
  now->searches = now->homes = false;
}

void jog_post(uint32_t motor, const struct jog_motion* request) {
  struct jog* j = &jogs[motor];
  struct motor_status_flags* status = &motors[motor].status;
  if ((jogs_busy & jog_bit(motor)) == 0u) j->rate = jog_rate_of(&motors[motor], request->by_program);
  j->request = *request;
  j->request_begins = j->clock + j->delay;
  j->requests++;
  status->trigger_move = request->searches && !request->homes;
  if (request->homes) status->home_complete = false;
  jogs_busy |= jog_bit(motor);
  jogs_asked |= jog_bit(motor);
}
