/* Of what was planned already: a word that is gathered may be read in each servo interrupt. */
#include "firmware/motion/motor_target.h"

#include <stdbool.h>

#include "firmware/base/mathematics.h"
#include "firmware/hal/hal.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/jog_state.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/piece.h"
#include "firmware/motion/system_motors.h"

/* A LINEAR move knows its end, whatever is blended there; of the others that of the piece which executes. */
static int64_t of_system(uint32_t motor, struct coordinate_system* s, double* corner, bool* has_corner) {
  *has_corner = false;
  if (!s->active || ((s->motors >> motor) & 1u) == 0u) return motors[motor].trajectory;
  if (s->moves[s->executing].kind == MOVE_LINEAR) {
    *corner = motor_moves[s->executing][motor].to;
    *has_corner = true;
  }
  const uint32_t number = s->ring.executing;
  const bool moves = number != s->ring.added && (piece_ring_at(&s->ring, number)->motors >> motor & 1u) != 0u;
  return moves ? cubic_end(piece_ring_cubic(&s->ring, number, motor)) : motors[motor].trajectory;
}

int64_t motor_target(uint32_t motor) {
  const struct motor* m = &motors[motor];
  double corner = 0.0;
  bool has_corner = false;
  const uint32_t state = hal_mask_servo();
  int64_t target = m->trajectory;
  if (m->path == PATH_SYSTEM)
    target = of_system(motor, &coordinate_systems[m->cs], &corner, &has_corner);
  else if (m->path == PATH_OWN && jog_now(&jogs[motor])->aim == AIM_TARGET)
    target = jog_now(&jogs[motor])->target;
  hal_unmask(state);
  return has_corner ? math_nearest(corner) : target;
}
