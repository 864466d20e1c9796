/* Two paths a motor: the one it is on, and one that the real-time task makes of the last request. A request does not
 * hold off an earlier one that is planned already and only waits for its Ixx92; a ramp does.
 *
 * Time is that of the motor's coordinate system, counted while there is something to do. What no program moves goes on
 * while the system is held: it takes the time base as commanded. */
#include "firmware/motion/jog.h"

#include "firmware/base/mathematics.h"
#include "firmware/hal/hal.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/capture.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/desired_position.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/own_path.h"
#include "firmware/variables/i_variables.h"

#define FASTEST 2147483648.0 /* 1/(32 Ixx08) counts a ms */
#define LONGEST_CHANGE_MS 8388608.0
#define STANDS_STILL 0.5 /* a speed below this is what roundings have left */

enum { SERVO_CYCLES_TO_PLAN = 2, SERVO_CYCLES_GIVEN_UP = 1024 };

enum aim { AIM_SPEED, AIM_REST, AIM_TARGET, AIM_RAMP };

struct motion {
  enum aim aim;
  bool searches, homes; /* for a trigger; which becomes home */
  bool by_program;      /* held with its coordinate system */
  double speed;         /* of AIM_SPEED with sign */
  double deceleration;  /* of AIM_RAMP */
  int64_t target;
  int64_t beyond; /* the trigger: where to then */
  struct speed_limits limits;
  struct capture capture;
};

struct jog {
  int64_t clock;       /* S */
  int32_t rate;        /* S: trajectory time a servo cycle */
  volatile bool ready; /* R: `next` and its path are complete; S: it is on it */
  uint32_t current;    /* S: of the paths */
  int64_t next_begins;
  struct motion now, next, request; /* S; R; any task, with the servo task held off */
  struct own_path paths[2];
  volatile uint32_t requests; /* so far, whatever makes R plan anew */
  int64_t request_begins;     /* earliest clock */
  int64_t delay;              /* Ixx92, of the last request */
  bool away;                  /* from `before`, by jogs. Requests, servo task held off; S */
  int64_t before;
};

static struct jog jogs[MOTORS];
/* A bit a motor: S has something to do, R has. Set with the servo task held off and by it, cleared so too. */
static volatile uint32_t busy, asked;

void jog_initialize(void) {
  busy = asked = 0;
  for (uint32_t motor = 0; motor < MOTORS; motor++) jogs[motor] = (struct jog){0};
}

/* Requests --------------------------------------------------------------------------------------------------------- */

static uint32_t bit(uint32_t motor) { return 1u << motor; }

static int32_t rate_of(uint32_t motor, bool by_program) {
  const struct coordinate_system* s = &coordinate_systems[motors[motor].cs];
  return s->held && !by_program ? s->increment_command : s->increment;
}

static double units(uint32_t motor) { return (double)POSITION_SUBCOUNT * (double)motors[motor].position_scale; }

static double real(uint32_t motor, enum i_real_name ixxnn) {
  return i_variable_read(I_MOTOR_BLOCK * (motor + 1u) + ixxnn);
}

static struct motion make(uint32_t motor, enum aim aim, double speed) {
  const double scale = units(motor), fast = speed * scale;
  struct motion request = {.aim = aim, .speed = fast < FASTEST ? fast : FASTEST};
  if (fast < -FASTEST) request.speed = -FASTEST;
  request.limits = speed_limits_make(real(motor, IXX19_JOG_ACCELERATION_LIMIT) * scale,
                                     i_variable_read(i_motor(motor + 1u, IXX20_JOG_ACCELERATION_TIME)),
                                     i_variable_read(i_motor(motor + 1u, IXX21_JOG_S_CURVE_TIME)));
  request.capture = capture_make(motor);
  return request;
}

static double jog_speed(uint32_t motor) { return math_absolute(real(motor, IXX22_JOG_SPEED)); }

static void leave_position(uint32_t motor) {
  struct jog* j = &jogs[motor];
  if (!j->away) j->before = motors[motor].trajectory;
  j->away = true;
}

/* Servo task held off. */
static void post(uint32_t motor, const struct motion* request) {
  struct jog* j = &jogs[motor];
  struct motor_status_flags* status = &motors[motor].status;
  if ((busy & bit(motor)) == 0u) j->rate = rate_of(motor, request->by_program);
  j->request = *request;
  j->request_begins = j->clock + j->delay;
  j->requests++;
  status->trigger_move = request->searches && !request->homes;
  if (request->homes) status->home_complete = false;
  busy |= bit(motor);
  asked |= bit(motor);
}

static bool ask(uint32_t motor, const struct motion* request) {
  const int64_t delay = (int64_t)i_integer(i_motor(motor + 1u, IXX92_JOG_CALCULATION_TIME)) << TRAJECTORY_FRACTION_BITS;
  const uint32_t state = hal_mask_servo();
  const bool closed = motors[motor].loop == LOOP_CLOSED;
  if (closed) {
    jogs[motor].delay = request->aim == AIM_RAMP ? 0 : delay;
    if (!request->by_program && !request->homes && request->aim != AIM_RAMP) leave_position(motor);
    post(motor, request);
  }
  hal_unmask(state);
  return closed;
}

bool jog_continuous(uint32_t motor, int direction) {
  const struct motion request = make(motor, AIM_SPEED, direction < 0 ? -jog_speed(motor) : jog_speed(motor));
  return ask(motor, &request);
}

bool jog_stop(uint32_t motor) {
  const struct motion request = make(motor, AIM_REST, 0.0);
  return ask(motor, &request);
}

static bool go(uint32_t motor, int64_t target, double speed, bool by_program) {
  struct motion request = make(motor, AIM_TARGET, speed);
  request.target = target;
  request.by_program = by_program;
  return ask(motor, &request);
}

static bool go_until(uint32_t motor, int64_t target, double speed, int64_t distance, bool by_program) {
  struct motion request = make(motor, AIM_TARGET, speed);
  request.target = target;
  request.by_program = by_program;
  request.searches = true;
  request.beyond = distance;
  return ask(motor, &request);
}

bool jog_to(uint32_t motor, int64_t target) { return go(motor, target, jog_speed(motor), false); }

bool jog_until(uint32_t motor, int64_t target, int64_t distance) {
  return go_until(motor, target, jog_speed(motor), distance, false);
}

bool jog_rapid(uint32_t motor, int64_t target, double speed) { return go(motor, target, speed, true); }

bool jog_rapid_until(uint32_t motor, int64_t target, double speed, int64_t distance) {
  return go_until(motor, target, speed, distance, true);
}

bool jog_home(uint32_t motor, double velocity, int64_t offset, bool by_program) {
  struct motion request = make(motor, AIM_SPEED, velocity);
  request.searches = request.homes = true;
  request.beyond = offset;
  request.by_program = by_program;
  return ask(motor, &request);
}

bool jog_stop_at(uint32_t motor, double deceleration) {
  struct motion request = make(motor, AIM_RAMP, 0.0);
  request.deceleration = deceleration * units(motor);
  return ask(motor, &request);
}

/* Servo task held off, or in it. */
static void nothing_moves(uint32_t motor) {
  struct motor_status_flags* status = &motors[motor].status;
  status->timed_move = status->aborting = status->home_search = false;
  jogs[motor].ready = false;
  jogs[motor].requests++;
  jogs[motor].now = (struct motion){.aim = AIM_REST};
  busy &= ~bit(motor);
  asked &= ~bit(motor);
}

void jog_drop(uint32_t motor) {
  nothing_moves(motor);
  motors[motor].path = PATH_STANDS;
}

void jog_program_takes(uint32_t motor) {
  nothing_moves(motor);
  jogs[motor].away = false;
  motors[motor].path = PATH_SYSTEM;
}

/* Where it stands ------------------------------------------------------------------------------------------------- */

bool jog_is_moving(uint32_t motor) { return (busy & bit(motor)) != 0u; }
bool jog_is_homing(uint32_t motor) { return jogs[motor].now.homes && jogs[motor].now.searches; }

int64_t jog_commanded(uint32_t motor) {
  const uint32_t state = hal_mask_servo();
  const int64_t position = motors[motor].trajectory;
  hal_unmask(state);
  return position;
}

/* The trajectory position that has the motor at `actual`. */
static int64_t trajectory_at(uint32_t motor, int64_t actual) {
  return actual - motors[motor].master + motors[motor].compensation;
}

int64_t jog_actual(uint32_t motor) {
  const uint32_t state = hal_mask_servo();
  const int64_t position = trajectory_at(motor, motors[motor].actual);
  hal_unmask(state);
  return position;
}

int64_t jog_position_before(uint32_t motor) {
  const uint32_t state = hal_mask_servo();
  const int64_t position = jogs[motor].away ? jogs[motor].before : motors[motor].trajectory;
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
  if (motors[motor].loop == LOOP_CLOSED && motors[motor].path == PATH_STANDS && !jog_is_moving(motor))
    motors[motor].trajectory = position;
  hal_unmask(state);
}

void jog_count_from(uint32_t motor, int64_t position) {
  struct jog* j = &jogs[motor];
  desired_position_shift(motor, -position);
  for (uint32_t path = 0; path < 2u; path++) j->paths[path].shift -= position;
  j->request.target -= position; /* a place: it stays where it is */
  j->requests++;                 /* what is being planned is about the old positions */
  j->away = false;
}

/* Servo task ------------------------------------------------------------------------------------------------------- */

/* Onto another time base no faster than the system itself may change: what is not held follows it at once. */
static int32_t approach(int32_t present, int32_t target, int32_t slew) {
  if (present < target) return target - present > slew ? present + slew : target;
  return present - target > slew ? present - slew : target;
}

static bool searches_without_end(const struct motion* motion) { return motion->aim == AIM_SPEED; }

/* The new path begins where the old one is: planned for this moment, a ramp off the path of a system about. */
static void change_over(uint32_t motor) {
  struct jog* j = &jogs[motor];
  struct motor* m = &motors[motor];
  struct own_path* path = &j->paths[j->current ^ 1u];
  if (j->next.aim == AIM_RAMP && m->path == PATH_SYSTEM) path->shift = m->trajectory - path->start;
  j->current ^= 1u;
  j->now = j->next;
  j->ready = false;
  m->path = PATH_OWN;
  m->status.timed_move = !searches_without_end(&j->now);
  m->status.aborting = j->now.aim == AIM_RAMP;
  m->status.home_search = j->now.searches;
  if (j->now.searches) capture_arm(&j->now.capture);
}

static void found(uint32_t motor, int64_t position) {
  struct jog* j = &jogs[motor];
  struct motor_status_flags* status = &motors[motor].status;
  const bool homes = j->now.homes;
  struct motion then = j->now;
  j->now.searches = false;
  status->home_search = status->trigger_move = false;
  then.aim = AIM_TARGET;
  then.searches = false;
  then.target = trajectory_at(motor, position) + then.beyond;
  if (homes) {
    jog_count_from(motor, then.target);
    then.target = 0;
    status->home_complete = true;
  }
  if (j->ready || (asked & bit(motor)) != 0u) return; /* something else has been asked for */
  then.homes = false;
  post(motor, &then);
}

static void over(uint32_t motor) {
  struct jog* j = &jogs[motor];
  struct motor_status_flags* status = &motors[motor].status;
  motors[motor].path = PATH_STANDS;
  status->timed_move = status->aborting = status->home_search = false;
  j->now = (struct motion){.aim = AIM_REST, .by_program = j->now.by_program};
  if (!j->ready && (asked & bit(motor)) == 0u) busy &= ~bit(motor);
}

/* What only few interrupts have to do stands apart: the rest is quicker without. */
static __attribute__((noinline)) void search(uint32_t motor) {
  int64_t position;
  if (capture_servo(motor, &jogs[motor].now.capture, &position)) found(motor, position);
}

static __attribute__((noinline)) int32_t other_rate(uint32_t motor, int32_t target) {
  const int32_t slew = coordinate_systems[motors[motor].cs].increment_slew;
  return approach(jogs[motor].rate, target < 0 ? 0 : target, slew);
}

static __attribute__((noinline)) bool begins(uint32_t motor, int64_t* elapsed) {
  const int64_t since = jogs[motor].clock - jogs[motor].next_begins;
  if (since < 0) return false;
  change_over(motor);
  *elapsed = since;
  return true;
}

static __attribute__((noinline)) void move(uint32_t motor) {
  struct jog* j = &jogs[motor];
  struct motor* m = &motors[motor];
  const int32_t target = rate_of(motor, j->now.by_program);
  if (m->loop != LOOP_CLOSED) {
    jog_drop(motor);
    return;
  }
  if (j->rate != target) j->rate = other_rate(motor, target);
  int64_t elapsed = j->rate;
  j->clock += elapsed;
  if (!(j->ready && begins(motor, &elapsed)) && m->path != PATH_OWN) return; /* a program moves it still, or nobody */
  const bool goes_on = own_path_advance(&j->paths[j->current], elapsed, &m->trajectory);
  if (j->now.searches) search(motor);
  if (!goes_on) over(motor);
}

void jog_servo(uint32_t motor) {
  if ((busy & bit(motor)) != 0u) move(motor);
}

/* Planning --------------------------------------------------------------------------------------------------------- */

/* What planning begins with, of one moment. */
struct beginning {
  uint32_t requests;
  struct motion motion;
  int64_t begins;
  struct own_path_place place;
  double speed; /* of a ramp off the path of a system */
};

enum look { LOOK_NOTHING, LOOK_LATER, LOOK_PLAN };

/* Servo task held off. */
static enum look look(uint32_t motor, uint32_t cycles, struct beginning* b) {
  struct jog* j = &jogs[motor];
  const struct motor* m = &motors[motor];
  if ((asked & bit(motor)) == 0u) return LOOK_NOTHING;
  if (m->loop != LOOP_CLOSED || (j->request.aim == AIM_RAMP && j->rate == 0)) {
    jog_drop(motor);
    return LOOK_NOTHING;
  }
  if (j->ready && j->request.aim != AIM_RAMP) return LOOK_LATER;
  j->ready = false;
  b->requests = j->requests;
  b->motion = j->request;
  b->begins = j->clock + (int64_t)j->rate * (int64_t)cycles;
  if (b->begins < j->request_begins) b->begins = j->request_begins;
  b->place = m->path == PATH_OWN ? own_path_place(&j->paths[j->current], b->begins - j->clock)
                                 : own_path_stands(m->trajectory);
  return LOOK_PLAN;
}

/* A piece of servo time's distance as a speed, of a motor that its system moves; else 0. */
static double system_speed(uint32_t motor) {
  const struct motor* m = &motors[motor];
  const int32_t increment = coordinate_systems[m->cs].increment;
  if (m->path != PATH_SYSTEM || increment <= 0) return 0.0;
  slice_pause();
  return (double)m->desired_step / math_scale((double)increment, -TRAJECTORY_FRACTION_BITS);
}

static void to_target(struct own_path* path, struct motion* m, double speed) {
  slice_pause();
  const double distance = (double)(m->target - path->start);
  const struct speed_plan plan = speed_plan_to(&m->limits, speed, distance, math_absolute(m->speed));
  own_path_change(path, &m->limits, speed, plan.speed);
  own_path_stay(path, plan.speed, plan.cruise);
  own_path_change(path, &m->limits, plan.speed, 0.0);
  own_path_end_at(path, m->target);
}

static void build(struct own_path* path, struct motion* m, struct own_path_state from) {
  if (math_absolute(from.speed) < STANDS_STILL) from.speed = 0.0;
  slice_pause();
  own_path_begin(path, math_to_integer(from.position + 0.5));
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

/* Servo task held off. False: the moment it was planned for is over, or something else is asked for. */
static bool hand_over(uint32_t motor, struct beginning* b) {
  struct jog* j = &jogs[motor];
  if (j->requests != b->requests || j->clock > b->begins) return false;
  j->next = b->motion;
  j->next_begins = b->begins;
  j->ready = true;
  asked &= ~bit(motor);
  return true;
}

/* Planned for a moment so near that it may be over too soon, then for later ones. */
static bool plan(uint32_t motor) {
  struct beginning b;
  for (uint32_t cycles = SERVO_CYCLES_TO_PLAN; cycles <= SERVO_CYCLES_GIVEN_UP; cycles *= 4u) {
    uint32_t state = hal_mask_servo();
    const enum look to_do = look(motor, cycles, &b);
    hal_unmask(state);
    if (to_do != LOOK_PLAN) return false;
    slice_pause();
    struct own_path_state from = own_path_state(&b.place);
    if (motors[motor].path == PATH_SYSTEM) from.speed = system_speed(motor);
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
  for (uint32_t left = asked; left != 0u; left &= left - 1u) any |= plan((uint32_t)__builtin_ctz(left));
  return any;
}
