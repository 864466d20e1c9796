#include "firmware/motion/desired_path.h"

#include "firmware/motion/compensation.h"
#include "firmware/motion/fixed_point.h"

struct desired_path desired_paths[MOTORS];

/* A table goes with the motor, wherever that is turned. */
void desired_path_take_actual(uint32_t motor) {
  struct motor* m = &motors[motor];
  struct desired_path* p = &desired_paths[motor];
  FIXED_IN_REGISTER(m);
  FIXED_IN_REGISTER(p);
  if ((compensation_of_position >> motor & 1u) != 0u) m->compensation = compensation_position(motor) + p->taken_up;
  const int64_t actual = m->actual, shown = actual - m->compensation;
  m->commanded = actual;
  m->desired_step = 0;
  if (m->held_back != 0) {
    m->master -= m->held_back;
    m->held_back = 0;
  }
  if (p->follows) p->master_reading = *p->master;
  m->trajectory = shown - m->master;
  p->turning = shown;
}
