/* Axis definitions are read, reported and guarded against double use. A definition has up to three axes of one triplet
 * (XYZ or UVW), or one of A, B, C, and an offset. */
#include "firmware/command/axis_commands.h"

#include "firmware/base/dimensions.h"
#include "firmware/command/reply.h"
#include "firmware/command/session.h"
#include "firmware/motion/axis_definition.h"
#include "firmware/run/run_control.h"

enum { TRIPLET_XYZ = 0x1C0, TRIPLET_UVW = 0x38 };

static const char LETTERS[] = "ABCUVWXYZ";
static const uint8_t REPORT_ORDER[] = {AXIS_X, AXIS_Y, AXIS_Z, AXIS_U, AXIS_V, AXIS_W, AXIS_A, AXIS_B, AXIS_C};

static bool accept_axis(struct lexer* lx, uint32_t* axis) {
  for (*axis = 0; *axis < AXIS_COUNT; ++*axis)
    if (lexer_accept(lx, LETTERS[*axis])) return true;
  return false;
}

static bool belongs_together(uint32_t mask) {
  return (mask & ~(uint32_t)TRIPLET_XYZ) == 0 || (mask & ~(uint32_t)TRIPLET_UVW) == 0 || (mask & (mask - 1u)) == 0;
}

/* {scale}axis{+-scale axis}{+-offset}; a scale may be left out, and one at least is not 0. */
static error_t parse(struct lexer* lx, struct axis_definition* d) {
  uint32_t mask = 0, axis;
  bool first = true, moves = false;
  for (;;) {
    double value = 1.0;
    char c = lexer_peek(lx);
    bool is_signed = c == '+' || c == '-';
    if (!first && !is_signed) break;
    bool negative = lexer_accept(lx, '-');
    if (!negative) (void)lexer_accept(lx, '+');
    bool has_number = lexer_number(lx, &value);
    if (value > LEXER_CONSTANT_LIMIT) return ERR_DATA;
    if (negative) value = -value;
    if (accept_axis(lx, &axis)) {
      if (mask & (1u << axis)) return ERR_DATA;
      mask |= 1u << axis;
      d->scale[axis] = value;
      moves = moves || value != 0.0;
    } else {
      if (!has_number || first) return ERR_DATA;
      d->offset = value;
      break;
    }
    first = false;
  }
  return moves && belongs_together(mask) ? ERR_NONE : ERR_DATA;
}

static void report(const struct axis_definition* d) {
  bool first = true;
  if (!d->assigned) reply_char('0');
  if (d->kinematic) reply_char('I');
  for (uint32_t i = 0; i < AXIS_COUNT; i++) {
    double scale = d->scale[REPORT_ORDER[i]];
    if (!d->assigned || scale == 0.0) continue;
    if (!first && scale > 0.0) reply_char('+');
    if (scale == -1.0)
      reply_char('-');
    else if (scale != 1.0)
      reply_number(scale);
    reply_char(LETTERS[REPORT_ORDER[i]]);
    first = false;
  }
  if (d->assigned && d->offset != 0.0) {
    if (d->offset > 0.0) reply_char('+');
    reply_number(d->offset);
  }
  reply_end_line();
}

static bool is_query(struct lexer* lx) {
  const char c = lexer_peek(lx);
  return c == '\0' || c == '#' || c == '&' || c == ',';
}

error_t axis_definition_command(struct lexer* lx) {
  const struct axis_definition* d = &axis_definitions[session.motor];
  struct axis_definition made = {0};
  struct lexer start = *lx;
  double zero;
  bool elsewhere = d->assigned && d->cs != session.cs;
  if (is_query(lx)) {
    static const struct axis_definition NONE = {0};
    report(elsewhere ? &NONE : d);
    return ERR_NONE;
  }
  if (run_is_running(session.cs)) return ERR_PROGRAM_RUNNING;
  made.assigned = true;
  made.cs = session.cs;
  if (lexer_number(&start, &zero) && zero == 0.0 && is_query(&start)) {
    *lx = start;
    if (elsewhere) return ERR_DATA;
    made.assigned = false;
  } else if (lexer_accept(lx, 'I')) {
    made.kinematic = true;
  } else {
    error_t error = parse(lx, &made);
    if (error != ERR_NONE) return error;
  }
  if (elsewhere) return ERR_DATA;
  axis_define(session.motor, &made);
  return ERR_NONE;
}

static bool any_running_has_motors(void) {
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++)
    if (run_is_running(cs) && axis_definition_motors(cs) != 0) return true;
  return false;
}

error_t axis_undefine_command(struct lexer* lx) {
  static const struct axis_definition NONE = {0};
  const bool all = lexer_keyword(lx, "ALL");
  if (all ? any_running_has_motors() : run_is_running(session.cs)) return ERR_PROGRAM_RUNNING;
  for (uint32_t motor = 0; motor < MOTORS; motor++)
    if (all || axis_definitions[motor].cs == session.cs) axis_define(motor, &NONE);
  return ERR_NONE;
}
