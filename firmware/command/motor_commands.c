/* Commands of single motors (motion:4.2 to motion:4.5): jogs, homing, open loop, kill, phase and
 * position references. What moves a motor closes its loop first, where it is. */
#include "firmware/command/motor_commands.h"

#include "firmware/base/float48.h"
#include "firmware/base/memory_map.h"
#include "firmware/base/status.h"
#include "firmware/command/session.h"
#include "firmware/hal/hal.h"
#include "firmware/language/statement.h"
#include "firmware/motion/axis_definition.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/homing.h"
#include "firmware/motion/jog.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/motor_state.h"
#include "firmware/motion/phase_search.h"
#include "firmware/motion/power_on_position.h"
#include "firmware/motion/segment.h"
#include "firmware/run/motor_stops.h"
#include "firmware/run/run_control.h"
#include "firmware/variables/i_variables.h"
#include "firmware/variables/words.h"

#define LARGEST_OUTPUT 100.0 /* per cent of Ixx69 */

/* What a program of its coordinate system moves is the program's. */
static error_t is_free(uint32_t motor) {
  const struct axis_definition* d = &axis_definitions[motor];
  return d->assigned && run_is_running(d->cs) ? ERR_PROGRAM_RUNNING : ERR_NONE;
}

/* It may be jogged away from where a hold has stopped it on the path; a move of its own goes on then. */
static bool is_held(uint32_t motor) {
  const struct coordinate_system* s = &coordinate_systems[axis_definitions[motor].cs];
  if (segment_stands(axis_definitions[motor].cs)) return true;
  return s->held && s->increment == 0 && !jog_is_of_program(motor);
}

static error_t may_enable(uint32_t motor, bool free) {
  if (i_integer(i_motor(motor + 1u, IXX00_ACTIVATED)) == 0) return ERR_NOT_ACTIVATED;
  if (!free) return ERR_PROGRAM_RUNNING;
  return status_motors_may_enable() ? ERR_NONE : ERR_PHASING;
}

/* Whether the motor may be moved, or enabled for that. */
static error_t may_move(uint32_t motor) { return may_enable(motor, is_free(motor) == ERR_NONE); }
static error_t may_jog(uint32_t motor) { return may_enable(motor, is_free(motor) == ERR_NONE || is_held(motor)); }

/* `HOME1`, `OR(...)`: program text that begins with the `length` characters of a command. */
static error_t program_text(const struct lexer* lx, uint32_t length) {
  const struct lexer word = {lx->at - length};
  return statement_starts(word) ? ERR_NEEDS_BUFFER : ERR_DATA;
}

/* Closed, unless `error` says why not. */
static error_t close_loop(uint32_t motor, error_t error) {
  if (error != ERR_NONE || motors[motor].loop == LOOP_CLOSED) return error;
  return motor_close(motor) ? ERR_NONE : ERR_PHASING;
}

/* No distance follows: the end, an address, a report, or behind a blank the word of another command. `J=P1` is none. */
static bool line_goes_on(struct lexer* lx) {
  const bool blank = *lx->at == ' ';
  const char c = lexer_peek(lx);
  return c == '\0' || c == '#' || c == '&' || c == '?' || (blank && c >= 'A' && c <= 'Z');
}

/* Counts; `*`: what stands in L:+$57 of the motor's registers. */
static error_t counts(struct lexer* lx, double* value) {
  if (!lexer_accept(lx, '*')) return lexer_constant(lx, value);
  struct float48 word;
  word_read_long(MEMORY_MOTOR_WORDS * (session.motor + 1u) + MEMORY_MOTOR_JOG, &word.x, &word.y);
  *value = float48_unpack(word);
  return ERR_NONE;
}

enum jog_from { FROM_ZERO, FROM_COMMANDED, FROM_ACTUAL };

static int64_t target_of(uint32_t motor, enum jog_from from, double distance) {
  const int64_t position = motor_position_of(motor, distance);
  if (from == FROM_ZERO) return position;
  return position + (from == FROM_COMMANDED ? jog_commanded(motor) : jog_actual(motor));
}

/* A position or distance, and ^d: until a trigger, then on by d. The loop is closed when nothing is wrong any more. */
static error_t jog_distance(struct lexer* lx, enum jog_from from, bool becomes_before) {
  const uint32_t motor = session.motor;
  double distance, beyond;
  error_t error = counts(lx, &distance);
  if (error != ERR_NONE) return error;
  const bool until = lexer_accept(lx, '^');
  if (until) error = lexer_constant(lx, &beyond);
  if (error == ERR_NONE) error = close_loop(motor, may_jog(motor));
  if (error != ERR_NONE) return error;
  const int64_t target = target_of(motor, from, distance);
  if (becomes_before) jog_set_position_before(motor, target);
  if (until)
    (void)jog_until(motor, target, motor_position_of(motor, beyond));
  else
    (void)jog_to(motor, target);
  return ERR_NONE;
}

/* Without end: no trigger can be added. */
static error_t jog_endless(struct lexer* lx, enum motor_jog how) {
  return lexer_peek(lx) == '^' ? ERR_DATA : motor_jog(session.motor, how);
}

static error_t jog_plus(struct lexer* lx) { return jog_endless(lx, MOTOR_JOG_PLUS); }
static error_t jog_minus(struct lexer* lx) { return jog_endless(lx, MOTOR_JOG_MINUS); }

static error_t jog_rest(struct lexer* lx) {
  (void)lx;
  return motor_jog(session.motor, MOTOR_JOG_STOP);
}

/* J=^d: back to where it was, until a trigger. */
static error_t jog_back_until(struct lexer* lx) {
  const uint32_t motor = session.motor;
  double beyond;
  error_t error = lexer_constant(lx, &beyond);
  if (error == ERR_NONE) error = close_loop(motor, may_jog(motor));
  if (error == ERR_NONE) (void)jog_until(motor, jog_position_before(motor), motor_position_of(motor, beyond));
  return error;
}

static error_t jog_equals(struct lexer* lx) {
  if (line_goes_on(lx)) return motor_jog(session.motor, MOTOR_JOG_BACK);
  if (lexer_accept(lx, '^')) return jog_back_until(lx);
  return jog_distance(lx, FROM_ZERO, lexer_accept(lx, '='));
}

static error_t jog_by(struct lexer* lx) { return jog_distance(lx, FROM_COMMANDED, false); }
static error_t jog_by_actual(struct lexer* lx) { return jog_distance(lx, FROM_ACTUAL, false); }

/* J!: a whole number of counts, of a motor that stands. */
static error_t jog_whole(struct lexer* lx) {
  (void)lx;
  const error_t error = may_jog(session.motor);
  if (error == ERR_NONE) jog_make_whole(session.motor);
  return error;
}

error_t motor_jog(uint32_t motor, enum motor_jog how) {
  const error_t error = close_loop(motor, how == MOTOR_HOME ? may_move(motor) : may_jog(motor));
  if (error != ERR_NONE) return error;
  if (how == MOTOR_JOG_STOP)
    (void)jog_stop(motor);
  else if (how == MOTOR_JOG_BACK)
    (void)jog_to(motor, jog_position_before(motor));
  else if (how == MOTOR_HOME)
    (void)homing_begin(motor, 0);
  else
    (void)jog_continuous(motor, how == MOTOR_JOG_PLUS ? 1 : -1);
  return ERR_NONE;
}

static error_t home(struct lexer* lx, uint32_t keyword) {
  if (lexer_value_starts(*lx)) return program_text(lx, keyword);
  return motor_jog(session.motor, MOTOR_HOME);
}

/* Only says where the motor is: its loop may be open. */
static error_t home_here(struct lexer* lx, uint32_t keyword) {
  if (lexer_value_starts(*lx)) return program_text(lx, keyword);
  const error_t error = may_move(session.motor);
  if (error == ERR_NONE) homing_here(session.motor);
  return error;
}

static error_t cmd_home(struct lexer* lx) { return home(lx, sizeof "HOME" - 1); }
static error_t cmd_hm(struct lexer* lx) { return home(lx, sizeof "HM" - 1); }
static error_t cmd_homez(struct lexer* lx) { return home_here(lx, sizeof "HOMEZ" - 1); }
static error_t cmd_hmz(struct lexer* lx) { return home_here(lx, sizeof "HMZ" - 1); }

static error_t cmd_kill(struct lexer* lx) {
  (void)lx;
  const error_t error = is_free(session.motor);
  if (error == ERR_NONE) motor_kill(session.motor);
  return error;
}

/* Which way an output would turn it is not known; what was found of a killed motor is old. */
static bool stands_in_limit(uint32_t motor) {
  const struct motor* m = &motors[motor];
  return m->loop != LOOP_KILLED && (m->found.positive_limit || m->found.negative_limit);
}

/* O{per cent}; with a motion buffer open it is a label. */
static error_t open_loop(struct lexer* lx) {
  double output;
  if (!lexer_value_starts(*lx)) return program_text(lx, 1);
  error_t error = lexer_constant(lx, &output);
  if (error != ERR_NONE) return error;
  if (output > LARGEST_OUTPUT) output = LARGEST_OUTPUT;
  if (output < -LARGEST_OUTPUT) output = -LARGEST_OUTPUT;
  error = may_move(session.motor);
  if (error == ERR_NONE && stands_in_limit(session.motor)) error = ERR_BOTH_LIMITS;
  if (error != ERR_NONE) return error;
  const double limit = i_variable_read(i_motor(session.motor + 1u, IXX69_OUTPUT_LIMIT));
  const uint32_t state = hal_mask_servo();
  jog_drop(session.motor);
  motor_open(session.motor, (int32_t)(output / LARGEST_OUTPUT * limit * (double)(1 << OUTPUT_FRACTION_BITS)));
  hal_unmask(state);
  return ERR_NONE;
}

/* $: the phase reference. $*: the position. */
static error_t refer(uint32_t motor, bool position) {
  error_t error = may_move(motor);
  if (error != ERR_NONE) return error;
  if (jog_is_moving(motor)) return ERR_PHASING;
  return (position ? power_on_position_read(motor) : phasing_begin(motor)) ? ERR_NONE : ERR_PHASING;
}

static error_t reference(struct lexer* lx) { return refer(session.motor, lexer_accept(lx, '*')); }

static error_t reference_all(struct lexer* lx) { /* $$, $$* */
  const bool position = lexer_accept(lx, '*');
  for (uint32_t motor = 0; motor < MOTORS; ++motor) {
    const struct axis_definition* d = &axis_definitions[motor];
    const error_t error = d->assigned && d->cs == session.cs ? refer(motor, position) : ERR_NONE;
    if (error != ERR_NONE) return error;
  }
  return ERR_NONE;
}

const struct command_entry motor_commands[] = {
    {"HOMEZ", cmd_homez}, {"HOME", cmd_home},    {"HMZ", cmd_hmz},      {"HM", cmd_hm},
    {"J+", jog_plus},     {"J-", jog_minus},     {"J/", jog_rest},      {"J!", jog_whole},
    {"J=", jog_equals},   {"J:", jog_by},        {"J^", jog_by_actual}, {"K", cmd_kill},
    {"O", open_loop},     {"$$", reference_all}, {"$", reference},      {0, 0},
};
