/* No loop is closed (motion/motor_status.h), so a jog, a homing search and a phase reference have nothing to move: they
 * are checked, taken or refused as those of a motor that stands, and its status stays what it is. HOMEZ says where the
 * motor is and so does all that it has to. */
#include "firmware/command/motor_commands.h"

#include "firmware/base/status.h"
#include "firmware/command/session.h"
#include "firmware/language/statement.h"
#include "firmware/motion/axis_definition.h"
#include "firmware/motion/motor_status.h"
#include "firmware/run/run_control.h"
#include "firmware/variables/i_variables.h"

#define LARGEST_OUTPUT 100.0 /* per cent of Ixx69 */

/* What a program of its coordinate system moves is the program's. */
static error_t is_free(uint32_t motor) {
  const struct axis_definition* d = &axis_definitions[motor];
  return d->assigned && run_is_running(d->cs) ? ERR_PROGRAM_RUNNING : ERR_NONE;
}

/* Whether the motor may be moved, or enabled for that. */
static error_t may_move(uint32_t motor) {
  if (i_integer(i_motor(motor + 1u, IXX00_ACTIVATED)) == 0) return ERR_NOT_ACTIVATED;
  if (is_free(motor) != ERR_NONE) return ERR_PROGRAM_RUNNING;
  return status_motors_may_enable() ? ERR_NONE : ERR_PHASING;
}

/* `HOME1`, `OR(...)`: program text that begins with the `length` characters of a command. */
static error_t program_text(const struct lexer* lx, uint32_t length) {
  const struct lexer word = {lx->at - length};
  return statement_starts(word) ? ERR_NEEDS_BUFFER : ERR_DATA;
}

/* ^d: until a trigger, then on by d. */
static error_t trigger_distance(struct lexer* lx) {
  double distance;
  return lexer_accept(lx, '^') ? lexer_constant(lx, &distance) : ERR_NONE;
}

/* A position or distance, or `*`: the one that stands in L:+$57 of the motor's registers. */
static error_t jog_distance(struct lexer* lx) {
  double distance;
  error_t error = lexer_accept(lx, '*') ? ERR_NONE : lexer_constant(lx, &distance);
  if (error == ERR_NONE) error = trigger_distance(lx);
  return error != ERR_NONE ? error : may_move(session.motor);
}

static error_t jog(struct lexer* lx) { /* J+ J- J/ */
  (void)lx;
  return may_move(session.motor);
}

static error_t jog_to(struct lexer* lx) { /* J= alone goes back to where the motor was before it jogged */
  const char c = lexer_peek(lx);
  return c == '\0' || c == '#' || c == '&' ? may_move(session.motor) : jog_distance(lx);
}

static error_t home(struct lexer* lx, uint32_t keyword, bool complete) {
  if (lexer_value_starts(*lx)) return program_text(lx, keyword);
  const error_t error = may_move(session.motor);
  if (error == ERR_NONE) motor_status_show_home(session.motor, complete);
  return error;
}

static error_t cmd_home(struct lexer* lx) { return home(lx, sizeof "HOME" - 1, false); } /* no trigger will come */
static error_t cmd_hm(struct lexer* lx) { return home(lx, sizeof "HM" - 1, false); }
static error_t cmd_homez(struct lexer* lx) { return home(lx, sizeof "HOMEZ" - 1, true); }
static error_t cmd_hmz(struct lexer* lx) { return home(lx, sizeof "HMZ" - 1, true); }

static error_t cmd_kill(struct lexer* lx) {
  (void)lx;
  return is_free(session.motor);
}

/* O{per cent}; with a motion buffer open it is a label. */
static error_t open_loop(struct lexer* lx) {
  double output;
  if (!lexer_value_starts(*lx)) return program_text(lx, 1);
  const error_t error = lexer_constant(lx, &output);
  if (error != ERR_NONE) return error;
  if (output < -LARGEST_OUTPUT || output > LARGEST_OUTPUT) return ERR_DATA;
  return may_move(session.motor);
}

static error_t reference(struct lexer* lx) { /* $, $* */
  (void)lexer_accept(lx, '*');
  return may_move(session.motor);
}

static error_t reference_all(struct lexer* lx) { /* $$, $$* */
  (void)lexer_accept(lx, '*');
  for (uint32_t motor = 0; motor < MOTORS; ++motor) {
    const struct axis_definition* d = &axis_definitions[motor];
    const error_t error = d->assigned && d->cs == session.cs ? may_move(motor) : ERR_NONE;
    if (error != ERR_NONE) return error;
  }
  return ERR_NONE;
}

const struct command_entry motor_commands[] = {
    {"HOMEZ", cmd_homez}, {"HOME", cmd_home}, {"HMZ", cmd_hmz},      {"HM", cmd_hm},       {"J+", jog},
    {"J-", jog},          {"J/", jog},        {"J=", jog_to},        {"J:", jog_distance}, {"J^", jog_distance},
    {"K", cmd_kill},      {"O", open_loop},   {"$$", reference_all}, {"$", reference},     {0, 0},
};
