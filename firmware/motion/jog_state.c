#include "firmware/motion/jog_state.h"

#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/motor.h"

struct jog jogs[MOTORS];
volatile uint32_t jogs_busy, jogs_asked;

/* What no program moves goes on while the system is held: it takes the time base as commanded. */
int32_t jog_rate_of(uint32_t motor, bool by_program) {
  const struct coordinate_system* s = &coordinate_systems[motors[motor].cs];
  return s->held && !by_program ? s->increment_command : s->increment;
}

bool jog_by_program(const struct jog* j) { return j->now.aim == AIM_REST ? j->request.by_program : j->now.by_program; }

void jog_post(uint32_t motor, const struct jog_motion* request) {
  struct jog* j = &jogs[motor];
  struct motor_status_flags* status = &motors[motor].status;
  if ((jogs_busy & jog_bit(motor)) == 0u) j->rate = jog_rate_of(motor, request->by_program);
  j->request = *request;
  j->request_begins = j->clock + j->delay;
  j->requests++;
  status->trigger_move = request->searches && !request->homes;
  if (request->homes) status->home_complete = false;
  jogs_busy |= jog_bit(motor);
  jogs_asked |= jog_bit(motor);
}
