/* Execution of program words, real-time task: statements in sequence until a move is calculated. LINEAR moves are
 * calculated one ahead, a DWELL lets nothing be calculated until it is over (firmware:7.9). Running out of lines is no
 * error in a rotary program: the coordinate system keeps running and waits. A round over all systems is made in slices
 * of the real-time task, left between words, inside functions and inside the planning of a move. */
#include "firmware/run/calculate.h"

#include <stdatomic.h>

#include "firmware/base/dimensions.h"
#include "firmware/buffers/rotary.h"
#include "firmware/kernel/slice.h"
#include "firmware/kernel/tasks.h"
#include "firmware/language/evaluator.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/plan.h"
#include "firmware/motion/position.h"
#include "firmware/variables/i_variables.h"

/* The system that the round under way is at; none: COORDINATE_SYSTEMS. R, and B with R held off. */
static uint32_t calculated = COORDINATE_SYSTEMS;

enum outcome { OUTCOME_NO_WORD, OUTCOME_WORD, OUTCOME_LINE, OUTCOME_MOVE, OUTCOME_ERROR };

static void set_rate(uint32_t cs, struct coordinate_system* s, uint32_t rate, double value) {
  static const enum i_name VARIABLE[] = {ISX89_FEEDRATE, ISX89_FEEDRATE, ISX87_ACCELERATION_TIME,
                                         ISX88_S_CURVE_TIME}; /* F, TM, TA, TS */
  i_variable_write(i_cs(cs, VARIABLE[rate]), value);
  if (rate == RATE_F) s->time_mode = false;
  if (rate == RATE_TM) s->time_mode = true;
}

static void set_axis(struct coordinate_system* s, uint32_t axis, double value) {
  bool incremental = (s->incremental >> axis) & 1u;
  s->pending[axis] = incremental ? s->position[axis] + value : value;
  s->pending_axes |= 1u << axis;
}

static bool is_wait(const struct instruction* in) {
  return (in->operation == OP_RATE || in->operation == OP_RATE_POP) &&
         (in->number == RATE_DWELL || in->number == RATE_DELAY);
}

/* One instruction without effect on moves. False: illegal. */
static bool execute(uint32_t cs, struct coordinate_system* s, const struct instruction* in, word48_t head,
                    word48_t raw) {
  double value = in->value, index;
  uint32_t number = in->number + (s->prefix << 10);
  s->prefix = 0;
  switch (in->operation) {
    case OP_BLANK:
      return true;
    case OP_PREFIX:
      s->prefix = in->number;
      return true;
    case OP_MODE:
      s->mode = (enum mode)in->number;
      return true;
    case OP_ABS:
    case OP_INC:
    case OP_FRAX:
      cs_set_axis_mode(s, in->operation, in->number);
      return true;
    case OP_AXIS_POP:
      if (in->number >= AXIS_COUNT || !evaluator_pop(&s->evaluator, &value)) return false;
      set_axis(s, in->number, value);
      return true;
    case OP_AXIS:
      set_axis(s, in->number, value);
      return true;
    case OP_RATE_POP:
      if (in->number >= RATE_DWELL || !evaluator_pop(&s->evaluator, &value)) return false;
      set_rate(cs, s, in->number, value);
      return true;
    case OP_RATE:
      set_rate(cs, s, in->number, value);
      return true;
    case OP_ASSIGN_POP:
      if (!evaluator_pop(&s->evaluator, &value)) return false;
      variable_write(in->group, cs, (double)number, value);
      return true;
    case OP_ASSIGN:
      variable_write(in->group, cs, (double)number, value);
      return true;
    case OP_ASSIGN_INDEXED:
      if (!evaluator_pop(&s->evaluator, &value) || !evaluator_pop(&s->evaluator, &index)) return false;
      variable_write(in->group, cs, index, value);
      return true;
    default:
      return evaluator_execute(&s->evaluator, in, head, raw, cs);
  }
}

static enum outcome end_of_line(uint32_t cs, struct coordinate_system* s) {
  s->evaluator.depth = 0;
  s->prefix = 0;
  if (s->pending_axes == 0) return OUTCOME_LINE;
  plan_line(cs);
  return OUTCOME_MOVE;
}

static enum outcome calculate_word(uint32_t cs, struct coordinate_system* s) {
  word48_t head, raw = 0;
  if (!rotary_peek(cs, 0, &head)) return OUTCOME_NO_WORD;
  if (head & WORD_START_OF_LINE) s->line_offset = rotary_buffers[cs].read;
  struct instruction in = word_decode(head);
  bool wide = in.operation == OP_PUSH_DOUBLE;
  if (wide && !rotary_peek(cs, 1, &raw)) return OUTCOME_ERROR;
  if (is_wait(&in)) {
    if (s->pending_axes != 0) { /* the axes before it on the line move first; the word is met again */
      plan_line(cs);
      return OUTCOME_MOVE;
    }
    double length = in.value;
    if (in.operation == OP_RATE_POP && !evaluator_pop(&s->evaluator, &length)) return OUTCOME_ERROR;
    plan_wait(cs, (enum rate)in.number, length);
    if (rotary_consume(cs, 1)) (void)end_of_line(cs, s);
    return OUTCOME_MOVE;
  }
  if (!execute(cs, s, &in, head, raw)) return OUTCOME_ERROR;
  return rotary_consume(cs, wide ? 2 : 1) ? end_of_line(cs, s) : OUTCOME_WORD;
}

static void stop_with_error(uint32_t cs, struct coordinate_system* s) {
  s->pending_axes = 0;
  s->evaluator.depth = 0;
  s->prefix = 0;
  (void)rotary_consume(cs, 1);
  rotary_skip_line_rest(cs);
  s->run_time_error = s->quit = true; /* behind the last pause: R there would forget them */
}

static void calculate_ahead(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  if (s->quit || s->end_block) {
    if (s->active || (s->next_valid && !s->end_block)) return; /* what is calculated is still to be executed */
    s->running = s->quit = s->stepping = false; /* end_block keeps a calculated move from starting until R */
    return;
  }
  if (s->next_valid || (s->active && s->moves[s->executing].kind == MOVE_DWELL)) return;
  for (uint32_t lines = 0; lines < CALCULATED_LINES_LIMIT;) {
    enum outcome outcome = calculate_word(cs, s);
    if (outcome == OUTCOME_ERROR) stop_with_error(cs, s);
    if (outcome == OUTCOME_MOVE && s->stepping) s->quit = true;
    if (outcome == OUTCOME_MOVE || outcome == OUTCOME_NO_WORD || outcome == OUTCOME_ERROR) return;
    slice_pause();
    if (outcome != OUTCOME_LINE) continue;
    if (s->quit || s->end_block) return; /* asked for since the round began: other slices have run */
    lines++;
  }
}

/* After an abort: the axes are where the stopped trajectory has them, what is left of a begun line is lost. The servo
 * task looks at nothing else while `settling`, so it falls last. */
static void settle(uint32_t cs, struct coordinate_system* s) {
  double position[AXIS_COUNT];
  cs_present_position(s, position);
  rotary_skip_line_rest(cs);
  s->active = s->next_valid = s->blend_decided = s->may_join = false;
  s->pending_axes = s->evaluator.depth = s->prefix = 0;
  for (uint32_t axis = 0; axis < AXIS_COUNT; axis++) {
    s->position[axis] = position[axis];
    s->velocity[axis] = 0.0;
  }
  atomic_signal_fence(memory_order_release);
  s->settling = false;
}

static void calculate_round(void) {
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++) {
    struct coordinate_system* s = &coordinate_systems[cs];
    calculated = cs;
    if (s->settling) settle(cs, s);
    if (s->running) calculate_ahead(cs);
  }
  calculated = COORDINATE_SYSTEMS;
}

void calculate_initialize(void) {
  calculated = COORDINATE_SYSTEMS;
  slice_initialize(calculate_round);
}

void calculate_forget(uint32_t cs) {
  if (calculated != cs) return;
  calculated = COORDINATE_SYSTEMS;
  slice_restart();
}

void calculate_programs(void) { slice_run(tasks_real_time_slice()); }
