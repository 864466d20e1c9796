#include "firmware/motion/plan_own.h"

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/homing.h"
#include "firmware/motion/jog.h"
#include "firmware/motion/plan_move.h"
#include "firmware/motion/system_motors.h"
#include "firmware/variables/i_variables.h"

/* Of the calculated move: where the motors go, and for a trigger how far behind it. One record for both is enough of a
 * motor, as for its moves. */
static struct {
  int64_t from, target, beyond;
  double speed; /* counts a ms */
  bool searches;
} goals[MOTORS];

/* Counts a ms; a speed of 0 or below would never arrive. */
static double rapid_speed(uint32_t motor) {
  const enum i_real_name name =
      i_integer(i_motor(motor + 1u, IXX90_RAPID_SPEED_SELECT)) != 0 ? IXX16_VELOCITY_LIMIT : IXX22_JOG_SPEED;
  return math_absolute(i_variable_read(i_motor_real(motor + 1u, name)));
}

/* Which of them move; and the longest time at their speeds, in ms. */
static uint32_t set_goals(uint32_t cs, const double target[AXIS_COUNT], double* longest) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  uint32_t moving = 0;
  *longest = 0.0;
  system_motors_solve(cs, s->position);
  for (uint32_t motor = 0, left = s->motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    goals[motor].from = math_nearest(system_motor_from(motor, s->position));
  }
  system_motors_solve(cs, target);
  for (uint32_t motor = 0, left = s->motors; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    const int64_t from = goals[motor].from;
    goals[motor].target = math_nearest(system_motor_at(motor, target));
    goals[motor].searches = system_motor_behind(motor, s->pending_triggers, s->pending_trigger, &goals[motor].beyond);
    slice_pause();
    if (goals[motor].target == from && !goals[motor].searches) continue;
    moving |= 1u << motor;
    goals[motor].speed = rapid_speed(motor);
    const double way = math_absolute(system_motor_counts(motor, goals[motor].target - from));
    if (goals[motor].speed > 0.0) *longest = plan_larger(*longest, way / goals[motor].speed);
    slice_pause();
  }
  return moving;
}

/* Isx79 = 0: all take as long as the slowest, about. */
static void stretch(uint32_t cs, uint32_t moving, double longest) {
  if (i_integer(i_cs(cs, ISX79_RAPID_CALCULATION)) != 0 || !(longest > 0.0)) return;
  for (uint32_t motor = 0, left = moving; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    const double way = math_absolute(system_motor_counts(motor, goals[motor].target - goals[motor].from));
    if (way > 0.0) goals[motor].speed = way / longest;
    slice_pause();
  }
}

void plan_rapid(uint32_t cs) {
  double target[AXIS_COUNT], longest;
  struct move* m = plan_begin(cs, MOVE_OWN);
  plan_targets(cs, m, target);
  m->own = set_goals(cs, target, &longest);
  m->homes = false;
  stretch(cs, m->own, longest);
  m->time = 1;
  plan_finish(cs, m, false, target);
}

void plan_home(uint32_t cs, uint32_t motors_to_home) {
  struct move* m = plan_begin(cs, MOVE_OWN);
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) m->delta[axis] = 0.0;
  m->own = motors_to_home;
  m->homes = true;
  m->time = 1;
  plan_finish(cs, m, false, coordinate_systems[cs].position);
}

/* One whose loop has been opened meanwhile does not go: what opened it ends the program too. */
static void begin(const struct move* m, uint32_t motor) {
  if (m->homes)
    (void)homing_begin(motor, m->own);
  else if (goals[motor].searches)
    (void)jog_rapid_until(motor, goals[motor].target, goals[motor].speed, goals[motor].beyond, m->own);
  else
    (void)jog_rapid(motor, goals[motor].target, goals[motor].speed, m->own);
}

void plan_own_begin(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  const struct move* m = &s->moves[s->executing ^ 1u];
  for (uint32_t motor = 0, left = m->own; left != 0; motor++, left >>= 1) {
    if ((left & 1u) == 0) continue;
    begin(m, motor);
    slice_pause();
  }
}
