/* Requests, and what everybody may know of a jog. */
#include "firmware/motion/jog.h"

#include "firmware/base/mathematics.h"
#include "firmware/hal/hal.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/desired_position.h"
#include "firmware/motion/jog_state.h"
#include "firmware/motion/motor.h"
#include "firmware/variables/i_variables.h"

#define FASTEST 2147483648.0 /* 1/(32 Ixx08) counts a ms */

void jog_initialize(void) {
  jogs_busy = jogs_asked = jogs_waiting = 0;
  for (uint32_t motor = 0; motor < MOTORS; motor++) jogs[motor] = (struct jog){0};
}

static double units(uint32_t motor) { return (double)POSITION_SUBCOUNT * (double)motors[motor].position_scale; }

static double real(uint32_t motor, enum i_real_name ixxnn) {
  return i_variable_read(I_MOTOR_BLOCK * (motor + 1u) + ixxnn);
}

static struct speed_limits limits_of(uint32_t motor) {
  return speed_limits_make(real(motor, IXX19_JOG_ACCELERATION_LIMIT) * units(motor),
                           i_variable_read(i_motor(motor + 1u, IXX20_JOG_ACCELERATION_TIME)),
                           i_variable_read(i_motor(motor + 1u, IXX21_JOG_S_CURVE_TIME)));
}

static struct jog_motion make(uint32_t motor, enum jog_aim aim, double speed) {
  const double scale = units(motor), fast = speed * scale;
  struct jog_motion request = {.aim = aim, .speed = fast < FASTEST ? fast : FASTEST};
  if (fast < -FASTEST) request.speed = -FASTEST;
  slice_pause();
  request.limits = limits_of(motor);
  slice_pause();
  request.capture = capture_make(motor);
  return request;
}

/* The speed of a RAPID move is the program's. */
void jog_take_speeds(uint32_t motor, struct jog_motion* motion) {
  slice_pause();
  motion->limits = limits_of(motor);
  slice_pause();
  if (motion->by_program && motion->triggered) return;
  const double speed = real(motor, (enum i_real_name)(IXX22_JOG_SPEED + (motion->triggered ? 0 : 1)));
  slice_pause();
  const double fast = math_absolute(speed) * units(motor);
  motion->speed = fast < FASTEST ? fast : FASTEST;
}

static double jog_speed(uint32_t motor) { return math_absolute(real(motor, IXX22_JOG_SPEED)); }

static void leave_position(uint32_t motor) {
  struct jog* j = &jogs[motor];
  if (!j->away) j->before = motors[motor].trajectory + motor_followed(motor);
  j->away = true;
}

/* Who stops a motor asks again and again while it moves: that must not put the ramp off. */
static bool stops_already(uint32_t motor) {
  struct jog* j = &jogs[motor];
  const bool waits = j->ready || (jogs_asked & jog_bit(motor)) != 0u;
  return waits ? j->request.aim == AIM_RAMP : motors[motor].path == PATH_OWN && jog_now(j)->aim == AIM_RAMP;
}

static bool goes_into_limit(uint32_t motor, const struct jog_motion* request) {
  if (request->aim != AIM_SPEED && request->aim != AIM_TARGET) return false;
  const uint32_t state = hal_mask_servo();
  const int64_t at = motors[motor].trajectory;
  hal_unmask(state);
  const bool up = request->aim == AIM_SPEED ? request->speed > 0.0 : request->target > at;
  const bool down = request->aim == AIM_SPEED ? request->speed < 0.0 : request->target < at;
  return (up || down) && jog_hooks.is_in_limit(motor, up, request->homes);
}

/* Further into a limit that the motor stands in: a command is taken and moves nothing, a program ends. */
static void post_out_of_limit(uint32_t motor, const struct jog_motion* request, bool into_limit) {
  if (!into_limit) {
    jog_post(motor, request);
    return;
  }
  if (request->homes) motors[motor].status.home_complete = false;
  if (request->by_program) jog_hooks.refuse(motor);
}

static bool ask(uint32_t motor, const struct jog_motion* request) {
  const int64_t delay = (int64_t)i_integer(i_motor(motor + 1u, IXX92_JOG_CALCULATION_TIME)) << TRAJECTORY_FRACTION_BITS;
  const bool into_limit = goes_into_limit(motor, request);
  const uint32_t state = hal_mask_servo();
  const bool closed = motors[motor].loop == LOOP_CLOSED;
  if (closed) {
    jogs[motor].delay = request->aim == AIM_RAMP ? 0 : delay;
    if (!request->by_program && !request->homes && request->aim != AIM_RAMP) leave_position(motor);
    if (request->aim != AIM_RAMP) {
      post_out_of_limit(motor, request, into_limit);
    } else if (!stops_already(motor)) {
      jog_post(motor, request);
      hal_request_real_time(); /* what stops a motor does not wait for its turn */
    }
  }
  hal_unmask(state);
  return closed;
}

bool jog_continuous(uint32_t motor, int direction) {
  const struct jog_motion request = make(motor, AIM_SPEED, direction < 0 ? -jog_speed(motor) : jog_speed(motor));
  return ask(motor, &request);
}

bool jog_stop(uint32_t motor) {
  const struct jog_motion request = make(motor, AIM_REST, 0.0);
  return ask(motor, &request);
}

/* `together`: of a program, which moves these. `target` is one of the trajectory. */
static bool go(uint32_t motor, int64_t target, double speed, uint32_t together) {
  struct jog_motion request = make(motor, AIM_TARGET, speed);
  request.target = target;
  request.by_program = together != 0u;
  request.together = together;
  return ask(motor, &request);
}

static bool go_until(uint32_t motor, int64_t target, double speed, int64_t distance, uint32_t together) {
  struct jog_motion request = make(motor, AIM_TARGET, speed);
  request.target = target;
  request.by_program = together != 0u;
  request.together = together;
  request.searches = true;
  request.beyond = distance;
  return ask(motor, &request);
}

static int64_t followed(uint32_t motor) {
  const uint32_t state = hal_mask_servo();
  const int64_t way = motor_followed(motor);
  hal_unmask(state);
  return way;
}

bool jog_to(uint32_t motor, int64_t target) { return go(motor, target - followed(motor), jog_speed(motor), 0); }

bool jog_until(uint32_t motor, int64_t target, int64_t distance) {
  return go_until(motor, target - followed(motor), jog_speed(motor), distance, 0);
}

bool jog_rapid(uint32_t motor, int64_t target, double speed, uint32_t together) {
  return go(motor, target, speed, together);
}

bool jog_rapid_until(uint32_t motor, int64_t target, double speed, int64_t distance, uint32_t together) {
  return go_until(motor, target, speed, distance, together);
}

bool jog_home(uint32_t motor, double velocity, int64_t offset, uint32_t together) {
  struct jog_motion request = make(motor, AIM_SPEED, velocity);
  request.searches = request.homes = true;
  request.beyond = offset;
  request.by_program = together != 0u;
  request.together = together;
  return ask(motor, &request);
}

bool jog_stop_at(uint32_t motor, double deceleration) {
  struct jog_motion request = make(motor, AIM_RAMP, 0.0);
  request.by_program = motors[motor].path == PATH_SYSTEM; /* at the rate of the path that it leaves, held or not */
  request.deceleration = deceleration * units(motor);
  return ask(motor, &request);
}

/* Servo task held off, or in it. */
static void nothing_moves(uint32_t motor) {
  struct motor_status_flags* status = &motors[motor].status;
  if (jog_is_triggered(motor)) status->trigger_move = false;
  status->timed_move = status->aborting = status->home_search = false;
  jog_not_ready(motor);
  jogs[motor].requests++;
  jog_rests(&jogs[motor]);
  jogs_busy &= ~jog_bit(motor);
  jogs_asked &= ~jog_bit(motor);
}

void jog_drop(uint32_t motor) {
  nothing_moves(motor);
  leave_position(motor);
  motors[motor].path = PATH_STANDS;
}

void jog_program_takes(uint32_t motor) {
  nothing_moves(motor);
  jogs[motor].away = false;
  motors[motor].path = PATH_SYSTEM;
}

/* Where it stands ------------------------------------------------------------------------------------------------- */

bool jog_is_moving(uint32_t motor) { return (jogs_busy & jog_bit(motor)) != 0u; }

bool jog_is_to_ramp(uint32_t motor) {
  const struct jog* j = &jogs[motor];
  return (j->ready || (jogs_asked & jog_bit(motor)) != 0u) && j->request.aim == AIM_RAMP;
}

bool jog_is_of_program(uint32_t motor) {
  if (!jog_is_moving(motor)) return false;
  const struct jog* j = &jogs[motor];
  const bool is_to_come = (j->ready || (jogs_asked & jog_bit(motor)) != 0u) && j->request.by_program;
  return is_to_come || jog_present(j)->by_program;
}

bool jog_is_homing(uint32_t motor) {
  const struct jog_motion* now = jog_now(&jogs[motor]);
  return now->homes && now->searches;
}

int64_t jog_commanded(uint32_t motor) {
  const uint32_t state = hal_mask_servo();
  const int64_t position = motors[motor].trajectory + motor_followed(motor);
  hal_unmask(state);
  return position;
}

int64_t jog_trajectory_at(uint32_t motor, int64_t actual) {
  return actual - motors[motor].master - motors[motor].compensation;
}

int64_t jog_actual(uint32_t motor) {
  const uint32_t state = hal_mask_servo();
  const int64_t position = jog_trajectory_at(motor, motors[motor].actual) + motor_followed(motor);
  hal_unmask(state);
  return position;
}

int64_t jog_position_before(uint32_t motor) {
  const uint32_t state = hal_mask_servo();
  const int64_t position = jogs[motor].away ? jogs[motor].before : motors[motor].trajectory + motor_followed(motor);
  hal_unmask(state);
  return position;
}

void jog_set_position_before(uint32_t motor, int64_t position) {
  const uint32_t state = hal_mask_servo();
  jogs[motor].before = position;
  jogs[motor].away = true;
  hal_unmask(state);
}

void jog_make_whole(uint32_t motor) {
  const double whole = (double)math_nearest(motor_counts_of(motor, jog_commanded(motor)));
  const int64_t position = motor_position_of(motor, whole);
  const uint32_t state = hal_mask_servo();
  if (motors[motor].loop == LOOP_CLOSED && !jog_is_moving(motor)) {
    leave_position(motor);
    motors[motor].path = PATH_STANDS;
    motors[motor].trajectory = position - motor_followed(motor);
  }
  hal_unmask(state);
}

void jog_count_from(uint32_t motor, int64_t position, int64_t corrections) {
  struct jog* j = &jogs[motor];
  struct motor* m = &motors[motor];
  desired_position_shift(motor, -position, corrections);
  FIXED_IN_REGISTER(j);
  FIXED_IN_REGISTER(m);
  for (uint32_t path = 0; path < 2u; path++) j->paths[path].shift -= position;
  j->request.target -= position; /* a place: it stays where it is */
  j->requests++;                 /* what is being planned is about the old positions */
  m->of_system -= position;
  j->before = motor_followed(motor) + m->trajectory;
  j->away = true;
}
