#include "firmware/run/motion_statement.h"

#include "firmware/language/statement_key.h"
#include "firmware/motion/axis_definition.h"
#include "firmware/motion/axis_matrix.h"
#include "firmware/motion/homing.h"
#include "firmware/motion/motor.h"
#include "firmware/motion/plan.h"
#include "firmware/motion/plan_linear.h"
#include "firmware/motion/plan_own.h"
#include "firmware/motion/plan_path.h"
#include "firmware/motion/segment.h"
#include "firmware/motion/system_motors.h"
#include "firmware/run/calls.h"
#include "firmware/run/matrix_statements.h"
#include "firmware/run/shared_statements.h"
#include "firmware/run/synchronous.h"

/* What stands in Isx89 otherwise is no F: Isx98 leaves it alone. */
static double clipped(uint32_t cs, double feedrate) {
  const double limit = cs_real(cs, ISX98_FEEDRATE_LIMIT);
  return limit > 0.0 && feedrate > limit ? limit : feedrate;
}

static void set_rate(uint32_t cs, uint32_t rate, double value) {
  static const uint8_t VARIABLE[] = {ISX89_FEEDRATE, ISX89_FEEDRATE, ISX87_ACCELERATION_TIME,
                                     ISX88_S_CURVE_TIME}; /* F, TM, TA, TS */
  i_variable_write(i_cs(cs, 0) + VARIABLE[rate], rate == RATE_F ? clipped(cs, value) : value);
  if (rate == RATE_F) coordinate_systems[cs].time_mode = false;
  if (rate == RATE_TM) coordinate_systems[cs].time_mode = true;
}

/* Axes, I, J, K and R: an error in the end leaves a fixed program at the first of them. */
static void begin_move(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  struct motion_program* p = &motion_programs[cs];
  if ((s->pending_axes | s->pending_vectors) != 0) return;
  p->move = p->x.at.statement;
  p->move_loops = p->x.at.loop_count;
}

static void set_axis(uint32_t cs, uint32_t axis, double value) {
  struct coordinate_system* s = &coordinate_systems[cs];
  begin_move(cs);
  if (s->pending_axes == 0) s->by_segments = plan_by_segments(cs);
  const bool incremental = !s->sets_position && ((s->incremental >> axis) & 1u) != 0;
  if (incremental) {
    const double way = value + s->carry[axis], from = axis_matrix_programmed(cs, axis);
    s->pending[axis] = from + way;
    s->carry[axis] = way - (s->pending[axis] - from);
  } else {
    s->pending[axis] = value;
    s->carry[axis] = 0.0;
  }
  s->pending_absolute = incremental ? s->pending_absolute & ~(1u << axis) : s->pending_absolute | 1u << axis;
  s->pending_axes |= 1u << axis;
}

/* The axes of a PSET line: nothing moves. */
static void set_position(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  system_motors_set_position(cs, s->pending_axes, s->pending);
  s->pending_axes = 0;
  s->sets_position = s->may_join = false;
}

enum executed motion_plan_line(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct motion_program* p = &motion_programs[cs];
  axis_matrix_line(cs);
  if (s->sets_position) {
    set_position(cs);
    return EXECUTED_WORD;
  }
  motion_program_trace(cs, &s->line);
  const enum run_time_error error = plan_line(cs);
  if (error == RUN_TIME_NONE) return EXECUTED_WORD;
  s->pending_triggers = s->pending_velocities = s->pending_vectors = 0;
  p->x.at.statement = p->move; /* a fixed program stays there: all of the move is met again, in the loops of its line */
  p->x.at.loop_count = p->move_loops;
  return executor_fail(&p->x, error);
}

static bool is_rate(const struct instruction* in) { return in->operation == OP_RATE || in->operation == OP_RATE_POP; }

static bool is_key(const struct instruction* in, uint32_t key) {
  return in->operation == OP_STATEMENT && in->number == key;
}

static bool is_list(const struct instruction* in, uint32_t key) { return in->operation == OP_LIST && in->group == key; }

/* The axes before it on its line move first; then it is met again. */
static bool comes_after_axes(const struct instruction* in) {
  return (is_rate(in) && in->number >= RATE_DWELL) || calls_is_call(in) || is_key(in, KEY_STOP) ||
         matrix_statement_is(in) || is_key(in, KEY_BLOCKSTART) || is_key(in, KEY_BLOCKSTOP) || is_key(in, KEY_WAIT) ||
         is_key(in, KEY_PSET) || is_list(in, KEY_HOME) || is_list(in, KEY_HOMEZ);
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
  if (in->number == RATE_DELAY && plan_by_segments(cs))
    plan_path_delay(cs, in->value);
  else
    plan_wait(cs, (enum rate)in->number, in->value);
  return executor_pass(&p->x);
}

/* What ends a step, a run, or the calculation of this interrupt, or asks for something with the next move: the line
 * goes on behind it. */
static bool is_mark(uint32_t cs, const struct instruction* in) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct motion_program* p = &motion_programs[cs];
  if (in->operation != OP_STATEMENT) return false;
  switch (in->number) {
    case KEY_STOP:
      s->quit = s->own_stop = true;
      break;
    case KEY_BLOCKSTART:
      p->in_block = true;
      break;
    case KEY_BLOCKSTOP:
      if (p->in_block && s->stepping) s->quit = true;
      p->in_block = false;
      break;
    case KEY_MOVETIME:
      p->asks_time = true;
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

/* Whether number is one of `count` from `first` on. */
static bool is_among(const struct instruction* in, uint32_t first, uint32_t count) {
  return (in->operation == OP_STATEMENT || in->operation == OP_STATEMENT_POP) && in->number - first < count;
}

/* I, J, K of NORMAL, which are 0 if they are not given; of a CIRCLE line, or its R. */
static enum executed arc_vector(uint32_t cs, uint32_t which, double value) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct motion_program* p = &motion_programs[cs];
  if (s->sets_normal && which < ARC_VECTORS - 1) {
    s->normal[which] = value;
    return executor_pass(&p->x);
  }
  if (s->mode != MODE_CIRCLE1 && s->mode != MODE_CIRCLE2) return EXECUTED_ERROR;
  begin_move(cs);
  s->pending_vector[which] = value;
  s->pending_vectors |= 1u << which;
  return executor_pass(&p->x);
}

/* STATEMENT: something else. */
static enum executed begin_normal(uint32_t cs, const struct instruction* in) {
  struct coordinate_system* s = &coordinate_systems[cs];
  if (!is_key(in, KEY_NORMAL)) return EXECUTED_STATEMENT;
  s->normal[0] = s->normal[1] = s->normal[2] = 0.0;
  s->sets_normal = true;
  return executor_pass(&motion_programs[cs].x);
}

/* A distance behind a trigger is that of motors along their own axes. */
static bool is_of_definitions(uint32_t cs) {
  return coordinate_systems[cs].inverse_motors == 0 && !axis_matrix_is_selected(cs);
}

/* Behind an axis, by the mode that knows it. STATEMENT: it is something else. */
static enum executed behind_axis(uint32_t cs, const struct instruction* in) {
  struct coordinate_system* s = &coordinate_systems[cs];
  struct motion_program* p = &motion_programs[cs];
  if (is_among(in, KEY_ARC_VECTOR, ARC_VECTORS)) return arc_vector(cs, in->number - KEY_ARC_VECTOR, in->value);
  if (is_among(in, KEY_TRIGGER, AXIS_COUNT)) {
    if (s->mode != MODE_RAPID || s->motors == 0 || !is_of_definitions(cs)) return EXECUTED_ERROR;
    s->pending_trigger[in->number - KEY_TRIGGER] = in->value;
    s->pending_triggers |= 1u << (in->number - KEY_TRIGGER);
    return executor_pass(&p->x);
  }
  if (is_among(in, KEY_VELOCITY, AXIS_COUNT)) {
    if (s->mode != MODE_PVT) return EXECUTED_ERROR;
    s->pending_velocity[in->number - KEY_VELOCITY] = in->value;
    s->pending_velocities |= 1u << (in->number - KEY_VELOCITY);
    return executor_pass(&p->x);
  }
  return EXECUTED_STATEMENT;
}

/* CIRCLE1 to PVT. STATEMENT: something else. */
static enum executed other_mode(uint32_t cs, const struct instruction* in) {
  struct coordinate_system* s = &coordinate_systems[cs];
  const uint32_t mode = in->number - KEY_MODE;
  if (!is_among(in, KEY_MODE + MODE_CIRCLE1, MODE_PVT - MODE_CIRCLE1 + 1)) return EXECUTED_STATEMENT;
  s->mode = (enum mode)mode;
  if (mode == MODE_PVT) set_rate(cs, i_integer(I42_PVT_TIME_SOURCE) != 0 ? RATE_TA : RATE_TM, in->value);
  return executor_pass(&motion_programs[cs].x);
}

static bool closed(uint32_t mask) {
  for (uint32_t motor = 0; mask != 0; motor++, mask >>= 1)
    if ((mask & 1u) != 0 && motors[motor].loop != LOOP_CLOSED) return false;
  return true;
}

/* What the program of another system moves is that one's. */
static bool may_home(uint32_t cs, uint32_t mask) {
  for (uint32_t motor = 0; mask != 0; motor++, mask >>= 1) {
    const struct axis_definition* d = &axis_definitions[motor];
    if ((mask & 1u) != 0 && d->assigned && d->cs != cs && coordinate_systems[d->cs].running) return false;
  }
  return true;
}

/* What is made at rest waits for the moves before it. STATEMENT: it is something else. */
static enum executed at_rest(uint32_t cs, const struct instruction* in) {
  struct coordinate_system* s = &coordinate_systems[cs];
  const bool sets = is_key(in, KEY_PSET);
  if (!sets && !is_list(in, KEY_HOMEZ)) return EXECUTED_STATEMENT;
  s->may_join = false;
  if (s->active || s->next_valid || segment_is_busy(cs)) return EXECUTED_LATER;
  if (sets) {
    s->sets_position = true;
    return executor_pass(&motion_programs[cs].x);
  }
  if (!may_home(cs, in->number)) return EXECUTED_ERROR;
  for (uint32_t motor = 0, left = in->number; left != 0; motor++, left >>= 1)
    if ((left & 1u) != 0) homing_here(motor);
  s->matching = s->motors != 0;
  return executor_pass(&motion_programs[cs].x);
}

static enum executed home(uint32_t cs, const struct instruction* in) {
  if (!may_home(cs, in->number) || !closed(in->number)) return EXECUTED_ERROR;
  motion_program_trace(cs, &coordinate_systems[cs].line);
  plan_home(cs, in->number);
  return executor_pass(&motion_programs[cs].x);
}

/* What is no part of a path made of segments needs the place of the next move. */
static bool waits_for_place(uint32_t cs, const struct instruction* in) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  const bool axis = in->operation == OP_AXIS || in->operation == OP_AXIS_POP;
  const bool moves = axis && s->pending_axes == 0 && !s->sets_position && !plan_by_segments(cs);
  const bool waits = is_rate(in) && (in->number == RATE_DWELL || (in->number == RATE_DELAY && !plan_by_segments(cs)));
  const bool mode = in->operation == OP_MODE || is_among(in, KEY_MODE, MODE_PVT + 1);
  if (!moves && !waits && !is_list(in, KEY_HOME) && !(mode && s->pending_axes != 0)) return false;
  return !segment_gives_way(cs);
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
  if (waits_for_place(cs, in)) return EXECUTED_LATER;
  if (is_mode(s, in) || is_mark(cs, in)) return executor_pass(&p->x);
  enum executed executed = behind_axis(cs, in);
  if (executed == EXECUTED_STATEMENT) executed = other_mode(cs, in);
  if (executed == EXECUTED_STATEMENT) executed = begin_normal(cs, in);
  if (executed == EXECUTED_STATEMENT) executed = matrix_statement(cs, in);
  if (executed == EXECUTED_STATEMENT) executed = at_rest(cs, in);
  if (executed != EXECUTED_STATEMENT) return executed;
  if (is_list(in, KEY_HOME)) return home(cs, in);
  switch (in->operation) {
    case OP_AXIS:
    case OP_AXIS_POP:
      if (in->number >= AXIS_COUNT) return EXECUTED_ERROR;
      s->sets_normal = false;
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
  executed = calls_execute(p, in);
  return executed == EXECUTED_STATEMENT ? shared(p, in) : executed;
}
