/* A request does not hold off an earlier one that is planned already and only waits for its Ixx92; a ramp does. */
#include "firmware/motion/jog_plan.h"

#include "firmware/base/mathematics.h"
#include "firmware/hal/hal.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/jog.h"
#include "firmware/motion/jog_state.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/time_base.h"

#define LONGEST_CHANGE_MS 8388608.0

enum { SERVO_CYCLES_TO_PLAN = 2, SERVO_CYCLES_GIVEN_UP = 1024 };

/* What planning begins with, of one moment. */
struct beginning {
  uint32_t requests;
  int32_t rate; /* of the system, for motion.rate */
  bool leaves;  /* it is a ramp off a program */
  struct jog_motion motion;
  int64_t begins;
  struct own_path_place place;
};

enum look { LOOK_NOTHING, LOOK_LATER, LOOK_PLAN };

/* Where a program has it `ahead` from now, in its last piece at the end of that. While time stands so does the motor.
 * Servo task held off. */
static void place_of_program(struct own_path_place* place, uint32_t motor, int64_t ahead) {
  const struct motor* m = &motors[motor];
  struct coordinate_system* s = &coordinate_systems[m->cs];
  struct piece_ring* ring = &s->ring;
  if (m->path == PATH_SYSTEM && s->active && s->increment > 0 && !piece_ring_is_empty(ring)) {
    uint32_t number = ring->executing;
    int64_t at = ring->elapsed + ahead;
    const struct piece* piece = piece_ring_at(ring, number);
    while (at >= piece->end && number + 1u != ring->added) {
      at -= piece->end;
      piece = piece_ring_at(ring, ++number);
    }
    if ((piece->motors >> motor & 1u) != 0u) {
      place->cubic = *piece_ring_cubic(ring, number, motor);
      place->time = piece->time;
      place->elapsed = at < piece->end ? at : piece->end - 1;
      place->warp = piece->warp;
      place->from = piece->from;
      place->to = piece->to;
      place->shape = SHAPE_OF_CUBIC;
      return;
    }
  }
  own_path_stands(place, m->trajectory);
}

/* What slows the program down on its way to another time base, as a hold does, slows no ramp off it: that goes on at
 * the one that is commanded, at 100 % for none, from the velocity that is left by then. */
static int32_t rate_of(const struct beginning* b, const struct coordinate_system* s) {
  if (!b->leaves) return 0;
  const int32_t target = s->held || s->time_base_source == 0 ? s->increment_command : time_base_external(s);
  if (b->rate == target) return 0;
  return target != 0 ? target : s->increment_full;
}

/* Servo task held off. */
static enum look look(uint32_t motor, uint32_t cycles, struct beginning* b) {
  struct jog* j = &jogs[motor];
  const struct motor* m = &motors[motor];
  if ((jogs_asked & jog_bit(motor)) == 0u) return LOOK_NOTHING;
  if (m->loop != LOOP_CLOSED || (j->request.aim == AIM_RAMP && j->rate == 0)) {
    jog_drop(motor);
    return LOOK_NOTHING;
  }
  if (j->ready && j->request.aim != AIM_RAMP) return LOOK_LATER;
  jog_not_ready(motor);
  b->requests = j->requests;
  b->motion = j->request;
  b->rate = m->path == PATH_OWN ? j->rate : coordinate_systems[m->cs].increment;
  b->leaves = b->motion.aim == AIM_RAMP && (m->path == PATH_SYSTEM || jog_now(j)->by_program);
  b->begins = j->clock + (int64_t)j->rate * (int64_t)cycles;
  b->begins = fixed_larger(b->begins, j->request_begins);
  if (m->path == PATH_OWN) {
    own_path_place(&b->place, &j->paths[j->current], b->begins - j->clock);
  } else {
    place_of_program(&b->place, motor, b->begins - j->clock);
  }
  return LOOK_PLAN;
}

static void to_target(struct own_path* path, struct jog_motion* m, double speed) {
  const double distance = (double)(m->target - path->start);
  const struct speed_plan plan = speed_plan_to(&m->limits, speed, distance, math_absolute(m->speed));
  own_path_change(path, &m->limits, speed, plan.speed);
  own_path_stay(path, plan.speed, plan.cruise);
  own_path_change(path, &m->limits, plan.speed, 0.0);
  own_path_end_at(path, m->target);
}

static void build(struct own_path* path, struct jog_motion* m, struct own_path_state from) {
  own_path_begin(path, math_to_integer(from.position + 0.5));
  slice_pause();
  const double fastest = math_absolute(from.speed) + math_absolute(m->speed), least = fastest / LONGEST_CHANGE_MS;
  slice_pause();
  if (!(m->limits.acceleration > least)) m->limits.acceleration = least;
  if (m->aim == AIM_TARGET && m->speed != 0.0) {
    to_target(path, m, from.speed);
  } else if (m->aim == AIM_RAMP) {
    const double time = math_divide(math_absolute(from.speed), m->deceleration);
    own_path_ramp(path, from.speed, time > 0.0 && time < LONGEST_CHANGE_MS ? time : 0.0);
  } else {
    const double speed = m->aim == AIM_SPEED ? m->speed : 0.0;
    own_path_change(path, &m->limits, from.speed, speed);
    if (speed != 0.0) own_path_stay_for_ever(path, speed);
  }
}

/* Servo task held off. False: the moment it was planned for is over, or something else is asked for. What begins
 * together stands until then, whenever that is. */
static bool hand_over(uint32_t motor, struct beginning* b) {
  struct jog* j = &jogs[motor];
  const bool alone = b->motion.together == 0u;
  if (j->requests != b->requests || (alone && j->clock > b->begins)) return false;
  *jog_next(j) = b->motion;
  j->next_begins = alone ? b->begins : INT64_MAX;
  j->ready = true;
  jogs_asked &= ~jog_bit(motor);
  if (!alone) jogs_waiting |= jog_bit(motor);
  return true;
}

/* The last of them is planned: they begin when Ixx92 has passed for all. */
static void begin_together(uint32_t motors_of_it) {
  int64_t longest = 0;
  for (uint32_t left = motors_of_it; left != 0u; left &= left - 1u) {
    const struct jog* j = &jogs[__builtin_ctz(left)];
    longest = fixed_larger(longest, j->request_begins - j->clock);
  }
  for (uint32_t left = motors_of_it; left != 0u; left &= left - 1u) {
    struct jog* j = &jogs[__builtin_ctz(left)];
    j->next_begins = j->clock + longest;
  }
  jogs_waiting &= ~motors_of_it;
}

/* What is asked for behind a move that waits comes after it, a ramp in its place. */
static bool is_planned(uint32_t together) {
  for (uint32_t left = together & jogs_asked; left != 0u; left &= left - 1u) {
    const uint32_t motor = (uint32_t)__builtin_ctz(left);
    if ((jogs_waiting & jog_bit(motor)) == 0u || jogs[motor].request.aim == AIM_RAMP) return false;
  }
  return true;
}

static void begin_waiting(void) {
  const uint32_t state = hal_mask_servo();
  for (uint32_t left = jogs_waiting; left != 0u;) {
    const uint32_t first = left & -left, together = jog_next(&jogs[__builtin_ctz(left)])->together | first;
    if (is_planned(together)) begin_together(together & jogs_waiting);
    left &= ~together;
  }
  hal_unmask(state);
}

/* Planned for a moment so near that it may be over too soon, then for later ones. */
static bool plan(uint32_t motor) {
  struct beginning b;
  for (uint32_t cycles = SERVO_CYCLES_TO_PLAN; cycles <= SERVO_CYCLES_GIVEN_UP; cycles *= 4u) {
    slice_pause();
    uint32_t state = hal_mask_servo();
    const enum look to_do = look(motor, cycles, &b);
    hal_unmask(state);
    if (to_do != LOOK_PLAN) return false;
    slice_pause();
    if (b.motion.anew) jog_take_speeds(motor, &b.motion);
    b.motion.rate = rate_of(&b, &coordinate_systems[motors[motor].cs]);
    struct own_path_state from = own_path_state(&b.place);
    if (b.motion.rate != 0) from.speed *= math_divide((double)b.rate, (double)b.motion.rate);
    struct own_path* path = &jogs[motor].paths[jogs[motor].current ^ 1u];
    build(path, &b.motion, from);
    slice_pause();
    state = hal_mask_servo();
    const bool done = hand_over(motor, &b);
    hal_unmask(state);
    if (done) return true;
  }
  return true;
}

bool jog_plan(void) {
  bool any = false;
  for (uint32_t left = jogs_asked; left != 0u; left &= left - 1u) any |= plan((uint32_t)__builtin_ctz(left));
  if (jogs_waiting != 0u) begin_waiting();
  return any;
}
