/* On-line commands of programs and axes (firmware:4.9, firmware:4.10). */
#include "firmware/command/program_commands.h"

#include "firmware/base/status.h"
#include "firmware/buffers/rotary.h"
#include "firmware/command/axis_commands.h"
#include "firmware/command/define_commands.h"
#include "firmware/command/reply.h"
#include "firmware/command/session.h"
#include "firmware/language/statement.h"
#include "firmware/language/statement_list.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/run/motor_stops.h"
#include "firmware/run/restart.h"
#include "firmware/run/run_control.h"

static error_t cmd_rotary_lines(struct lexer* lx) { /* PR */
  (void)lx;
  const struct rotary* ring = &rotary_buffers[session.cs];
  if (ring->size == 0) return ERR_DATA;
  reply_integer((int64_t)ring->lines);
  reply_end_line();
  return ERR_NONE;
}

/* P1:22>P1000.4: program and line, and what that has called. */
static error_t report_trace(const struct program_trace* trace) {
  if (coordinate_systems[session.cs].pointer == POINTER_NONE) return ERR_DATA;
  for (uint32_t i = 0; i <= trace->depth; i++) {
    reply_text(i == 0 ? "P" : ">P");
    reply_integer(trace->places[i].program);
    reply_char(i == 0 ? ':' : '.');
    reply_integer(trace->places[i].offset);
  }
  reply_end_line();
  return ERR_NONE;
}

static error_t cmd_calculating(struct lexer* lx) { /* PC */
  struct program_trace trace;
  (void)lx;
  run_calculating(session.cs, &trace);
  return report_trace(&trace);
}

static error_t cmd_executing(struct lexer* lx) { /* PE */
  struct program_trace trace;
  (void)lx;
  run_executing(session.cs, &trace);
  return report_trace(&trace);
}

static error_t cmd_point(struct lexer* lx) { /* B{n}; B(1) moves an axis */
  double program;
  if (lexer_constant(lx, &program) == ERR_NONE) return run_point(session.cs, program);
  const struct lexer word = {lx->at - 1};
  return statement_starts(word) ? ERR_NEEDS_BUFFER : ERR_DATA;
}

static error_t cmd_run(struct lexer* lx) {
  (void)lx;
  return run_start(session.cs, false);
}

static error_t cmd_match(struct lexer* lx) { /* PMATCH */
  (void)lx;
  return run_match(session.cs);
}

static error_t cmd_step(struct lexer* lx) {
  (void)lx;
  return run_start(session.cs, true);
}

static error_t control(struct lexer* lx, void (*action)(uint32_t cs)) {
  (void)lx;
  action(session.cs);
  return ERR_NONE;
}

static error_t cmd_quit(struct lexer* lx) { return control(lx, run_quit); }
static error_t cmd_abort(struct lexer* lx) { return control(lx, motors_abort); }

/* A word or a value, of whatever sort. */
static bool begins_something(char c) {
  for (const char* sign = "+-.,=($"; *sign != '\0'; sign++)
    if (c == *sign) return true;
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z');
}

static error_t cmd_abort_and_run(struct lexer* lx) { /* ABR{n}; what is refused aborts nothing */
  double program = 0.0;
  const char next = lexer_peek(lx);
  const bool has_number = lexer_constant(lx, &program) == ERR_NONE;
  if (!has_number && begins_something(next)) return ERR_DATA;
  return restart_begin(session.cs, has_number, program);
}

static error_t cmd_hold(struct lexer* lx) { return control(lx, run_hold); }

static error_t cmd_enable(struct lexer* lx) { /* E */
  if (!status_motors_may_enable()) return ERR_PHASING;
  return control(lx, motors_enable);
}

static error_t cmd_program_hold(struct lexer* lx) {
  (void)lx;
  run_stop_on_path(session.cs);
  return ERR_NONE;
}

static error_t cmd_resume_forward(struct lexer* lx) {
  (void)lx;
  return run_forward(session.cs);
}

static error_t cmd_resume_back(struct lexer* lx) {
  (void)lx;
  return run_back(session.cs);
}

static error_t cmd_end_block(struct lexer* lx) {
  (void)lx;
  run_end_block(session.cs);
  return ERR_NONE;
}

static error_t cmd_time_base(struct lexer* lx) {
  double percent;
  struct lexer start = *lx;
  if (lexer_number(&start, &percent)) {
    *lx = start;
    return run_set_time_base(session.cs, percent);
  }
  if (*start.at == '-' || *start.at == '+') return ERR_DATA;
  reply_number(run_time_base(session.cs));
  reply_end_line();
  return ERR_NONE;
}

/* ABS, INC, FRAX, NOFRAX on-line: at once, for the addressed coordinate system. */
static error_t axis_mode(struct lexer* lx, enum operation operation) {
  struct coordinate_system* s = &coordinate_systems[session.cs];
  uint32_t mask;
  error_t error = operation == OP_FRAX ? statement_frax_list(lx, &mask) : statement_axis_list(lx, AXIS_ALL, &mask);
  if (error != ERR_NONE) return error;
  cs_set_axis_mode(s, operation, mask);
  return ERR_NONE;
}

static error_t cmd_abs(struct lexer* lx) { return axis_mode(lx, OP_ABS); }
static error_t cmd_inc(struct lexer* lx) { return axis_mode(lx, OP_INC); }
static error_t cmd_frax(struct lexer* lx) { return axis_mode(lx, OP_FRAX); }

static error_t cmd_nofrax(struct lexer* lx) {
  (void)lx;
  cs_set_axis_mode(&coordinate_systems[session.cs], OP_FRAX, 0);
  return ERR_NONE;
}

static error_t cmd_needs_buffer(struct lexer* lx) {
  (void)lx;
  return ERR_NEEDS_BUFFER;
}

const struct command_entry program_commands[] = {{"->", axis_definition_command},
                                                 {"UNDEFINE", axis_undefine_command},
                                                 {"UNDEF", axis_undefine_command},
                                                 {"NOFRAX", cmd_nofrax},
                                                 {"PMATCH", cmd_match},
                                                 {"DEFINE", define_command},
                                                 {"DELETE", delete_command},
                                                 {"DELAY", cmd_needs_buffer}, /* not DEL AY */
                                                 {"FRAX", cmd_frax},
                                                 {"ABS", cmd_abs},
                                                 {"ABR", cmd_abort_and_run},
                                                 {"INC", cmd_inc},
                                                 {"DEF", define_command},
                                                 {"DEL", delete_command},
                                                 {"PR", cmd_rotary_lines},
                                                 {"PC", cmd_calculating},
                                                 {"PE", cmd_executing},
                                                 {"A", cmd_abort},
                                                 {"B", cmd_point},
                                                 {"E", cmd_enable},
                                                 {"H", cmd_hold},
                                                 {"Q", cmd_quit},
                                                 {"R", cmd_run},
                                                 {"S", cmd_step},
                                                 {"/", cmd_end_block},
                                                 {"\\", cmd_program_hold},
                                                 {">", cmd_resume_forward},
                                                 {"<", cmd_resume_back},
                                                 {"%", cmd_time_base},
                                                 {0, 0}};
