#include "firmware/run/restart.h"

#include "firmware/base/dimensions.h"
#include "firmware/buffers/rotary.h"
#include "firmware/kernel/background.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/run/calls.h"
#include "firmware/run/motor_stops.h"
#include "firmware/run/run_control.h"

static uint32_t waiting; /* bit a system; one that something else has been told since is none of them any more */

error_t restart_begin(uint32_t cs, bool has_number, double program) {
  struct coordinate_system* s = &coordinate_systems[cs];
  uint32_t number, label;
  if (!calls_split(program, &number, &label)) return ERR_DATA;
  motors_abort(cs);
  if (rotary_buffers[cs].size != 0) rotary_clear(cs);
  if (!has_number) program = s->pointer == POINTER_FIXED ? (double)s->fixed_program : 0.0;
  const error_t error = run_point(cs, program);
  if (error != ERR_NONE) return error;
  if (s->pointer == POINTER_NONE || (program == 0.0 && rotary_buffers[cs].size == 0)) return ERR_NO_PROGRAM;
  s->restarts = true;
  waiting |= 1u << cs;
  background_wake();
  return ERR_NONE;
}

void restart_pass(void) {
  for (uint32_t cs = 0, left = waiting; left != 0; cs++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    struct coordinate_system* s = &coordinate_systems[cs];
    if (s->restarts && run_start(cs, false) == ERR_MOVE_IN_PROGRESS) continue;
    s->restarts = false;
    waiting &= ~(1u << cs);
  }
}
