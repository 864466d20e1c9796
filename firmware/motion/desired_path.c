#include "firmware/motion/desired_path.h"

#include "firmware/hal/hal.h"
#include "firmware/kernel/tasks.h"
#include "firmware/motion/compensation.h"
#include "firmware/motion/fixed_point.h"

enum { LOOKS = 4 }; /* the last is taken as it is: a source has moved on for an interrupt */

struct desired_path desired_paths[MOTORS];

static inline void stand(struct motor* m, struct desired_path* p) {
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

static inline bool has_tables(uint32_t motor) { return (compensation_of_position >> motor & 1u) != 0u; }

/* A table goes with the motor, wherever that is turned. */
void desired_path_take_actual(uint32_t motor) {
  struct motor* m = &motors[motor];
  struct desired_path* p = &desired_paths[motor];
  FIXED_IN_REGISTER(m);
  FIXED_IN_REGISTER(p);
  if (has_tables(motor)) m->compensation = compensation_position(motor) + p->taken_up;
  stand(m, p);
}

void desired_path_stand(uint32_t motor) { stand(&motors[motor], &desired_paths[motor]); }

int64_t desired_path_corrections(uint32_t motor, int64_t position) {
  const struct motor* m = &motors[motor];
  if (!has_tables(motor)) return 0;
  const uint32_t state = hal_mask_servo();
  const bool closed = m->loop == LOOP_CLOSED;
  const int64_t place = closed ? position + m->master - motor_followed(motor) : position;
  hal_unmask(state);
  return compensation_there(motor, closed, place);
}

uint32_t desired_path_hold(uint32_t motor, int64_t position, int64_t* corrections) {
  for (uint32_t looks = 1;; ++looks) {
    const uint32_t servo = tasks_servo_count(), changes = compensation_changes();
    const enum motor_loop loop = motors[motor].loop;
    *corrections = desired_path_corrections(motor, position);
    const uint32_t state = hal_mask_servo();
    const bool there = tasks_servo_count() == servo && compensation_changes() == changes && motors[motor].loop == loop;
    if (there || looks == LOOKS) return state;
    hal_unmask(state);
  }
}

void desired_path_look_at_tables(uint32_t motor) {
  struct motor* m = &motors[motor];
  if (!has_tables(motor)) return;
  uint32_t state = hal_mask_servo();
  const int64_t actual = m->actual;
  hal_unmask(state);
  int64_t corrections;
  state = desired_path_hold(motor, actual, &corrections);
  m->compensation += compensation_exchange(motor, corrections);
  hal_unmask(state);
}
