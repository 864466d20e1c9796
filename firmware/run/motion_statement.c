#include "firmware/run/motion_statement.h"

#include "firmware/language/statement_key.h"
#include "firmware/motion/plan.h"
#include "firmware/run/calls.h"
#include "firmware/run/shared_statements.h"
#include "firmware/run/synchronous.h"

static void set_rate(uint32_t cs, uint32_t rate, double value) {
  static const uint8_t VARIABLE[] = {ISX89_FEEDRATE, ISX89_FEEDRATE, ISX87_ACCELERATION_TIME,
                                     ISX88_S_CURVE_TIME}; /* F, TM, TA, TS */
  i_variable_write(i_cs(cs, 0) + VARIABLE[rate], value);
  if (rate == RATE_F) coordinate_systems[cs].time_mode = false;
  if (rate == RATE_TM) coordinate_systems[cs].time_mode = true;
}

static void set_axis(uint32_t cs, uint32_t axis, double value) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct motion_program* p = &motion_programs[cs];
  if (s->pending_axes == 0) {
    p->axes = p->x.at.statement;
    p->axes_loops = p->x.at.loop_count;
  }
  bool incremental = (s->incremental >> axis) & 1u;
  s->pending[axis] = incremental ? s->position[axis] + value : value;
  s->pending_axes |= 1u << axis;
}

enum executed motion_plan_line(uint32_t cs) {
  struct motion_program* p = &motion_programs[cs];
  motion_program_trace(cs, &coordinate_systems[cs].line);
  if (plan_line(cs)) return EXECUTED_WORD;
  p->x.at.statement = p->axes; /* a fixed program stays there: all of the move is met again, in the loops of its line */
  p->x.at.loop_count = p->axes_loops;
  return executor_fail(&p->x, RUN_TIME_FEEDRATE);
}

static bool is_rate(const struct instruction* in) { return in->operation == OP_RATE || in->operation == OP_RATE_POP; }

static bool is_key(const struct instruction* in, uint32_t key) {
  return in->operation == OP_STATEMENT && in->number == key;
}

/* The axes before it on its line move first; then it is met again. */
static bool comes_after_axes(const struct instruction* in) {
  return (is_rate(in) && in->number >= RATE_DWELL) || calls_is_call(in) || is_key(in, KEY_STOP) ||
         is_key(in, KEY_BLOCKSTART) || is_key(in, KEY_BLOCKSTOP) || is_key(in, KEY_WAIT);
}

/* Those of PLCs too. What commands address is &1 #1, whoever executes (firmware:7.2). */
static enum executed shared(struct motion_program* p, const struct instruction* in) {
  static const struct program_caller caller = {.task = PROGRAM_REAL_TIME, .cs = 0, .motor = 0};
  switch (shared_statement(&p->x, in, &caller)) {
    case OUTPUT_DONE:
      return executor_pass(&p->x);
    case OUTPUT_LATER:
      return EXECUTED_LATER;
    default:
      return EXECUTED_ERROR;
  }
}

static enum executed rate(uint32_t cs, const struct instruction* in) {
  struct motion_program* p = &motion_programs[cs];
  if (in->number < RATE_DWELL) {
    set_rate(cs, in->number, in->value);
    return executor_pass(&p->x);
  }
  motion_program_trace(cs, &coordinate_systems[cs].line);
  plan_wait(cs, (enum rate)in->number, in->value);
  return executor_pass(&p->x);
}

/* What ends a step, a run, or the calculation of this interrupt: the line goes on behind it. */
static bool is_stop(uint32_t cs, const struct instruction* in) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct motion_program* p = &motion_programs[cs];
  if (in->operation != OP_STATEMENT) return false;
  switch (in->number) {
    case KEY_STOP:
      s->quit = true;
      break;
    case KEY_BLOCKSTART:
      p->in_block = true;
      break;
    case KEY_BLOCKSTOP:
      if (p->in_block && s->stepping) s->quit = true;
      p->in_block = false;
      break;
    case KEY_WAIT:
      s->may_join = false;
      p->lines = CALCULATED_LINES_LIMIT;
      break;
    default:
      return false;
  }
  return true;
}

static bool is_mode(struct coordinate_system* s, const struct instruction* in) {
  switch (in->operation) {
    case OP_MODE:
      s->mode = (enum mode)in->number;
      return true;
    case OP_ABS:
    case OP_INC:
    case OP_FRAX:
      cs_set_axis_mode(s, in->operation, in->number);
      return true;
    default:
      return false;
  }
}

enum executed motion_statement(uint32_t cs, const struct instruction* in) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct motion_program* p = &motion_programs[cs];
  if (s->pending_axes != 0 && comes_after_axes(in)) return motion_plan_line(cs);
  if (is_mode(s, in) || is_stop(cs, in)) return executor_pass(&p->x);
  switch (in->operation) {
    case OP_AXIS:
    case OP_AXIS_POP:
      if (in->number >= AXIS_COUNT) return EXECUTED_ERROR;
      set_axis(cs, in->number, in->value);
      return executor_pass(&p->x);
    case OP_RATE:
    case OP_RATE_POP:
      return in->number < RATE_COUNT ? rate(cs, in) : EXECUTED_ERROR;
    case OP_SYNCHRONOUS:
    case OP_SYNCHRONOUS_INDEXED:
      return synchronous_add(cs, in);
    default:
      break;
  }
  if (synchronous_is_short(in)) return synchronous_add(cs, in);
  const enum executed executed = calls_execute(p, in);
  return executed == EXECUTED_STATEMENT ? shared(p, in) : executed;
}
