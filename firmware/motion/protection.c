#include "firmware/motion/protection.h"

#include "firmware/base/status.h"
#include "firmware/hal/hal.h"
#include "firmware/motion/axis_definition.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/jog.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/motor_flags.h"
#include "firmware/motion/motor_state.h"
#include "firmware/motion/overload.h"
#include "firmware/motion/position_loop.h"
#include "firmware/motion/system_findings.h"
#include "firmware/motion/system_motors.h"
#include "firmware/variables/i_variables.h"

enum { PART_OF_COUNT = 16, LIMIT_KILLS = 1 << 8, DESIRED_LIMITS = 1 << 15, OTHERS_SHIFT = 21 }; /* bits of Ixx24 */
enum { ROUNDED = 4 }; /* by which a path that is held at a limit may be beyond it */
enum others { OTHERS_ALL, OTHERS_OF_SYSTEM, OTHERS_NONE };

static struct guard {
  int64_t fatal_error, warning_error, in_position; /* position; V. INT64_MAX: not looked at */
  int64_t positive_limit, negative_limit;          /* of software, the same; */
  int64_t positive_desired, negative_desired;      /* of the desired position, further out by ROUNDED */
  uint32_t scans_wanted;                           /* Ixx88 + 1 */
  uint32_t scans;                                  /* B: in position one after the other */
  bool integral_trips, limit_kills;
  enum others others;
} guards[MOTORS];

uint32_t protection_watched;
volatile uint32_t protection_always_watched;

enum { FIRST_TURN = 0x11111111 };     /* motors that are looked at in the first of PROTECTION_TURNS */
static uint32_t turn, urgent_watched; /* S: which it is; bit n: what is urgent about motor n is looked for */
static volatile bool asked;           /* S sets, R clears: a pass does not wait for its turn */

static volatile uint32_t ending;  /* bit n: the program of system n is to end. V, Q set, R clears */
static volatile uint32_t refused; /* bit n: a program has asked for more of motor n, in a limit. Q sets, R clears */
static volatile bool foreground;  /* I13, as the last pass has seen it */
static volatile bool stands;      /* B */

void protection_initialize(void) {
  __builtin_memset(guards, 0, sizeof guards);
  overload_initialize();
  foreground = stands = asked = false;
  protection_watched = protection_always_watched = turn = urgent_watched = ending = refused = 0;
  system_findings_initialize();
}

static int32_t variable(uint32_t motor, enum i_name ixxnn) { return i_integer(i_motor(motor, ixxnn)); }

/* Variables -------------------------------------------------------------------------------------------------------- */

static int64_t band_of(uint32_t motor, enum i_name ixxnn) {
  const int32_t sixteenths = variable(motor, ixxnn);
  return (int64_t)sixteenths * (POSITION_SUBCOUNT / PART_OF_COUNT) * motors[motor - 1u].position_scale;
}

static int64_t unless_zero(int64_t value, int64_t off) { return value == 0 ? off : value; }

static int64_t limit_of(uint32_t motor, uint32_t side, int64_t off) {
  const double counts = i_variable_read(I_MOTOR_BLOCK * motor + (uint32_t)IXX13_SOFTWARE_LIMITS + side);
  return counts == 0.0 ? off : motor_position_of(motor - 1u, counts);
}

/* Nearer by Ixx41 than a limit that is on. */
static int64_t nearer(int64_t limit, int64_t off, int64_t by) { return limit == off ? off : limit - by; }

void protection_motor_changed(uint32_t motor) {
  struct guard* g = &guards[motor - 1u];
  const uint32_t mode = (uint32_t)variable(motor, IXX24_FLAG_MODE);
  g->fatal_error = unless_zero(band_of(motor, IXX11_FATAL_ERROR_LIMIT), INT64_MAX);
  g->warning_error = unless_zero(band_of(motor, IXX12_WARNING_ERROR_LIMIT), INT64_MAX);
  g->in_position = band_of(motor, IXX28_IN_POSITION_BAND);
  g->positive_limit = limit_of(motor, 0, INT64_MAX);
  g->negative_limit = limit_of(motor, 1, INT64_MIN);
  const bool desired = (mode & DESIRED_LIMITS) != 0u;
  const int64_t band = desired ? motor_position_of(motor - 1u, variable(motor, IXX41_DESIRED_POSITION_LIMIT)) : 0;
  g->positive_desired = desired ? nearer(g->positive_limit, INT64_MAX, band - ROUNDED) : INT64_MAX;
  g->negative_desired = desired ? nearer(g->negative_limit, INT64_MIN, ROUNDED - band) : INT64_MIN;
  g->scans_wanted = (uint32_t)variable(motor, IXX88_IN_POSITION_SCANS) + 1u;
  g->integral_trips = variable(motor, IXX63_INTEGRATION_LIMIT) < 0;
  g->limit_kills = (mode & LIMIT_KILLS) != 0u;
  g->others = (enum others)(mode >> OTHERS_SHIFT & 3u);
  overload_motor_changed(motor);
}

/* What there is to see --------------------------------------------------------------------------------------------- */

struct view { /* of one moment */
  int64_t actual, commanded;
  int64_t error; /* of the last closure of the loop, as `actual` is: the motor is commanded on until the next */
  int32_t velocity, desired_step;
  enum motor_loop loop;
};

/* Servo task held off, or in it. */
static inline struct view look_now(uint32_t motor) {
  const struct motor* m = &motors[motor];
  return (struct view){m->actual, m->commanded, m->closed_at - m->actual, m->velocity, m->desired_step, m->loop};
}

static struct view look(uint32_t motor) {
  const uint32_t state = hal_mask_servo();
  const struct view view = look_now(motor);
  hal_unmask(state);
  return view;
}

static int64_t magnitude(int64_t value) { return value < 0 ? -value : value; }

/* On its way by a jog or by a program, a DWELL too. Who belongs to no system any more is where one has left it. */
static bool is_moved(uint32_t motor) {
  if (jog_is_moving(motor)) return true;
  const struct axis_definition* d = &axis_definitions[motor];
  return d->assigned && motors[motor].path == PATH_SYSTEM && coordinate_systems[d->cs].active;
}

static bool is_in_position(uint32_t motor, int64_t error, int32_t desired_step) {
  return desired_step == 0 && magnitude(error) < guards[motor].in_position && !is_moved(motor);
}

/* What is done about it -------------------------------------------------------------------------------------------- */

static bool is_of_system(uint32_t motor, uint32_t cs) {
  return axis_definitions[motor].assigned && axis_definitions[motor].cs == cs;
}

static void abort_programs(uint32_t systems) {
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; ++cs)
    if ((systems >> cs & 1u) != 0u) protection_hooks.abort(cs);
}

/* A program whose motor is dead does not run on: that of its coordinate system, and one that homes it. */
static uint32_t systems_of(uint32_t motor) {
  const struct axis_definition* d = &axis_definitions[motor];
  const uint32_t moved = jog_is_of_program(motor) ? 1u << system_motor_mover(motor) : 0u;
  return d->assigned ? moved | 1u << d->cs : moved;
}

static void kill(uint32_t motor) {
  const uint32_t systems = motors[motor].loop != LOOP_KILLED ? systems_of(motor) : 0u;
  motor_kill(motor);
  abort_programs(systems);
}

/* The motor is killed and others as Ixx24 says. All enables fall before programs are looked for. */
static void trip(uint32_t motor) {
  const struct axis_definition* d = &axis_definitions[motor];
  const enum others others = guards[motor].others;
  uint32_t systems = systems_of(motor);
  motor_kill(motor);
  for (uint32_t other = 0; other < MOTORS; ++other) {
    if (others != OTHERS_ALL && !(others == OTHERS_OF_SYSTEM && d->assigned && is_of_system(other, d->cs))) continue;
    if (motors[other].loop != LOOP_KILLED) systems |= systems_of(other);
    motor_kill(other);
  }
  abort_programs(systems);
}

/* The writer of a variable may be the program itself, in the middle of a line. */
void protection_kill(uint32_t motor) {
  if (motors[motor].loop == LOOP_KILLED) return;
  const uint32_t systems = systems_of(motor); /* nobody moves it any more when it is dead */
  motor_kill(motor);
  const uint32_t state = hal_mask_servo();
  ending |= systems;
  hal_unmask(state);
}

void protection_begin(uint32_t cs) {
  ending &= ~(1u << cs);
  refused &= ~axis_motors[cs];
}

static bool goes_on(uint32_t cs) { return coordinate_systems[cs].running || coordinate_systems[cs].active; }

static void end_programs(void) {
  const uint32_t state = hal_mask_servo(), systems = ending;
  for (uint32_t left = refused; left != 0u; left &= left - 1u) motors[__builtin_ctz(left)].found.on_limit = true;
  ending = refused = 0;
  hal_unmask(state);
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; ++cs)
    if ((systems >> cs & 1u) != 0u && goes_on(cs)) protection_hooks.abort(cs);
}

/* A program moves it: on the path, or by itself (RAPID, HOME). What somebody has jogged meanwhile only its own keeps.
 */
static uint32_t program_of(uint32_t motor) {
  const struct axis_definition* d = &axis_definitions[motor];
  if (d->assigned && motors[motor].path == PATH_SYSTEM) return d->cs;
  const uint32_t mover = system_motor_mover(motor);
  return (d->assigned && mover == d->cs) || jog_is_of_program(motor) ? mover : COORDINATE_SYSTEMS;
}

/* A motor that a program moves takes the coordinate system with it. An open loop is closed. */
static void stop(uint32_t motor) {
  const uint32_t cs = program_of(motor);
  if (cs < COORDINATE_SYSTEMS)
    protection_hooks.abort(cs);
  else if (motor_close(motor))
    (void)jog_stop_at(motor, i_variable_read(I_MOTOR_BLOCK * (motor + 1u) + (uint32_t)IXX15_ABORT_DECELERATION));
  else
    kill(motor);
}

/* What it moves, or would move with the loop open. */
static bool goes(const struct view* view, int direction) {
  const int32_t by = view->loop == LOOP_CLOSED ? view->desired_step : view->velocity;
  return direction > 0 ? by > 0 : by < 0;
}

static bool is_at_input(uint32_t motor, bool up) {
  return up ? motor_flags_positive_limit(motor) : motor_flags_negative_limit(motor);
}

static bool has_passed(const struct guard* g, const struct view* view, bool up) {
  return up ? view->actual >= g->positive_limit : view->actual <= g->negative_limit;
}

static bool is_at_software_limit(uint32_t motor, const struct view* view, bool up) {
  return has_passed(&guards[motor], view, up) && !jog_is_homing(motor);
}

static bool is_beyond_desired(uint32_t motor, const struct view* view, bool up) {
  const struct guard* g = &guards[motor];
  return (up ? view->commanded > g->positive_desired : view->commanded < g->negative_desired) && !jog_is_homing(motor);
}

bool protection_is_in_limit(uint32_t motor, bool up, bool homes) {
  const struct guard* g = &guards[motor];
  const struct view view = look_now(motor);
  if (is_at_input(motor, up)) return true;
  const bool beyond = up ? view.commanded > g->positive_desired : view.commanded < g->negative_desired;
  return !homes && (beyond || has_passed(g, &view, up));
}

/* The move that asks has not begun. */
void protection_refuse(uint32_t motor) {
  refused |= 1u << motor;
  ending |= 1u << system_motor_mover(motor);
  asked = true;
  hal_request_real_time();
}

/* Overtravel input and software limit. An input in front of a software limit that is on says that the position is
 * wrong: it may be told to trip. */
static void check_limit(uint32_t motor, const struct view* view, int direction) {
  const struct guard* g = &guards[motor];
  struct motor_findings* found = &motors[motor].found;
  const bool up = direction > 0;
  const bool input = is_at_input(motor, up), beyond = is_at_software_limit(motor, view, up);
  const bool has_software = up ? g->positive_limit != INT64_MAX : g->negative_limit != INT64_MIN;
  const bool trips = input && g->limit_kills && has_software && !has_passed(g, view, up), limited = input || beyond;
  if (limited && goes(view, direction) && (trips || !motors[motor].status.aborting)) {
    if (trips)
      trip(motor);
    else
      stop(motor);
    found->on_limit = true; /* an open loop that was closed has forgotten what was found */
  }
  if (up)
    found->positive_limit = limited;
  else
    found->negative_limit = limited;
}

/* Of the desired position, Ixx24 bit 15. */
static void check_desired(uint32_t motor, const struct view* view, int direction) {
  struct motor_findings* found = &motors[motor].found;
  const bool beyond = is_beyond_desired(motor, view, direction > 0);
  if (direction > 0)
    found->positive_desired = beyond;
  else
    found->negative_desired = beyond;
  if (!beyond || !goes(view, direction) || motors[motor].status.aborting) return;
  found->on_desired_limit = true;
  stop(motor);
}

bool protection_desired_limits(uint32_t motor, int64_t* lowest, int64_t* highest) {
  *lowest = nearer(guards[motor].negative_desired, INT64_MIN, -ROUNDED);
  *highest = nearer(guards[motor].positive_desired, INT64_MAX, ROUNDED);
  return *lowest != INT64_MIN || *highest != INT64_MAX;
}

static void check_limits(uint32_t motor, const struct view* view) {
  struct motor_findings* found = &motors[motor].found;
  if (view->desired_step != 0 && !motors[motor].status.aborting)
    found->on_limit = found->on_desired_limit = false; /* it goes away */
  for (int direction = -1; direction <= 1; direction += 2) {
    if (view->loop == LOOP_CLOSED) check_desired(motor, view, direction);
    check_limit(motor, view, direction);
  }
}

/* True: the loop is not closed any more. */
static bool check_fault(uint32_t motor) {
  const bool overload = overload_is_too_much(motor);
  if (!overload && !motor_flags_fault(motor)) return false;
  trip(motor);
  motors[motor].found.amplifier_fault = true;
  motors[motor].found.integrated_current = overload;
  return true;
}

static bool integral_trips(uint32_t motor) { return guards[motor].integral_trips && position_loop_is_limited(motor); }

static bool check_error(uint32_t motor, const struct view* view) {
  const struct guard* g = &guards[motor];
  struct motor_findings* found = &motors[motor].found;
  const int64_t error = magnitude(view->error);
  const bool integral = integral_trips(motor);
  found->warning_error = error > g->warning_error;
  if (error <= g->fatal_error && !integral) return false;
  trip(motor);
  found->fatal_error = true;
  found->integrated_error = integral;
  return true;
}

static void check_in_position(uint32_t motor, const struct view* view) {
  struct guard* g = &guards[motor];
  if (!is_in_position(motor, view->error, view->desired_step))
    g->scans = 0;
  else if (g->scans < g->scans_wanted)
    g->scans++;
  motors[motor].found.in_position = g->scans >= g->scans_wanted;
}

/* The warning of a motor that its error has tripped stands with that. */
static void not_closed(uint32_t motor) {
  struct motor_findings* found = &motors[motor].found;
  guards[motor].scans = 0;
  found->in_position = false;
  if (!found->fatal_error) found->warning_error = false;
}

static void check(uint32_t motor) {
  if (motors[motor].loop == LOOP_KILLED) return not_closed(motor); /* the usual way of motors that nobody uses */
  const struct view view = look(motor);
  if (!status_motors_may_enable()) kill(motor); /* no clock: nothing is controlled */
  if (motors[motor].loop == LOOP_KILLED || check_fault(motor)) return not_closed(motor);
  check_limits(motor, &view);
  if (view.loop != LOOP_CLOSED || motors[motor].loop != LOOP_CLOSED || check_error(motor, &view))
    return not_closed(motor);
  check_in_position(motor, &view);
}

void protection_stand(bool still) { stands = still; }

void protection_pass(void) {
  if (stands) return;
  asked = false;
  if ((ending | refused) != 0u) end_programs();
  foreground = i_variable_foreground_in_position();
  protection_always_watched = foreground ? UINT32_MAX : 0u;
  uint32_t left = motors_active;
  for (uint32_t motor = 0; left != 0u; ++motor, left >>= 1)
    if ((left & 1u) != 0u) check(motor);
  system_findings_show();
}

bool protection_is_asked_for(void) { return asked; }

/* Servo task ------------------------------------------------------------------------------------------------------- */

static __attribute__((noinline)) bool is_urgent_seldom(uint32_t motor, bool beyond) {
  return (beyond && !jog_is_homing(motor)) || integral_trips(motor);
}

/* What the pass would act upon. A motor that stands in a limit is none of it. First what needs no call. */
static bool is_urgent(uint32_t motor) {
  const struct motor* m = &motors[motor];
  const struct guard* g = &guards[motor];
  FIXED_IN_REGISTER(m);
  FIXED_IN_REGISTER(g);
  const bool closed = m->loop == LOOP_CLOSED;
  const int64_t commanded = m->commanded, actual = m->actual;
  const int32_t by = closed ? m->desired_step : m->velocity;
  if (closed && magnitude(m->closed_at - actual) > g->fatal_error) return true;
  bool beyond = false;
  if (by > 0) beyond = actual >= g->positive_limit || (closed && commanded > g->positive_desired);
  if (by < 0) beyond = actual <= g->negative_limit || (closed && commanded < g->negative_desired);
  if ((beyond || (closed && g->integral_trips)) && is_urgent_seldom(motor, beyond)) return true;
  if ((overload_watched >> motor & 1u) != 0u && overload_is_too_much_now(motor)) return true;
  return motor_flags_stop(motor, (by > 0) - (by < 0));
}

void protection_take_turn(void) {
  urgent_watched = stands ? 0u : motors_enabled & (uint32_t)FIRST_TURN << turn;
  turn = (turn + 1u) % PROTECTION_TURNS;
  protection_watched = foreground ? UINT32_MAX : urgent_watched;
}

static __attribute__((noinline)) void look_foreground(uint32_t motor) {
  const struct motor* m = &motors[motor];
  motors[motor].found.foreground_in_position =
      m->loop == LOOP_CLOSED && is_in_position(motor, m->closed_at - m->actual, m->desired_step);
}

void protection_look(uint32_t motor) {
  if ((urgent_watched >> motor & 1u) != 0u && protection_takes_turns() && is_urgent(motor)) {
    asked = true;
    hal_request_real_time();
  }
  if (foreground) look_foreground(motor);
}
