#include "firmware/run/executor.h"

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"
#include "firmware/language/statement_key.h"

void executor_begin(struct executor* x, uint32_t cs) {
  const struct program_reader reader = x->at.reader;
  x->at = (struct program_position){.reader = reader};
  x->cs = cs;
  x->prefix = x->evaluator.depth = 0;
  x->condition.open = false;
  x->error = RUN_TIME_NONE;
}

static void begin_line(struct executor* x) {
  x->at.in_line = x->at.begun = false;
  x->prefix = x->evaluator.depth = 0;
  x->condition.open = false;
}

enum executed executor_end_line(struct executor* x) {
  begin_line(x);
  if (x->at.loop_count == 0) return EXECUTED_LINE;
  x->at.reader.offset = x->at.loops[--x->at.loop_count];
  x->jumps_back++;
  return EXECUTED_LINE;
}

enum executed executor_jump(struct executor* x, uint32_t offset) {
  x->at.loop_count = 0;
  if (offset <= x->at.reader.offset) x->jumps_back++;
  x->at.reader.offset = offset;
  return executor_end_line(x);
}

void executor_back(struct executor* x) {
  x->at.reader.offset = x->at.statement;
  begin_line(x);
}

void executor_skip_line(struct executor* x) {
  if (x->at.in_line || x->at.reader.rotary) reader_skip_line(&x->at.reader);
  x->at.loop_count = 0;
  (void)executor_end_line(x);
}

static enum executed advance(struct executor* x, uint32_t words) {
  x->at.in_line = true;
  return reader_advance(&x->at.reader, words) ? executor_end_line(x) : EXECUTED_WORD;
}

static enum executed end_statement(struct executor* x, uint32_t words) {
  x->at.begun = false;
  x->prefix = 0;
  return advance(x, words);
}

static bool compare(uint32_t comparator, double a, double b) {
  bool result;
  switch (comparator >> 1) { /* odd: negated */
    case 0:
      result = a == b;
      break;
    case 1:
      result = a > b;
      break;
    case 2:
      result = a < b;
      break;
    default:
      result = math_absolute(a - b) < 0.5;
      break;
  }
  return result != ((comparator & 1u) != 0);
}

static bool is_key(struct executor* x, uint32_t key) {
  word48_t word;
  if (reader_peek(&x->at.reader, 0, &word) != READER_WORD) return false;
  const struct instruction in = word_decode(word);
  return in.operation == OP_STATEMENT && in.number == key;
}

/* A condition that governs the rest of its line. */
static enum executed decide_line(struct executor* x, bool is_true) {
  if (is_true) {
    if (x->condition.kind != CONDITION_WHILE) return EXECUTED_WORD;
    if (x->at.loop_count == ONE_LINE_LOOPS) return executor_fail(x, RUN_TIME_BLOCK);
    x->at.loops[x->at.loop_count++] = (uint16_t)x->at.statement;
    return EXECUTED_WORD;
  }
  reader_skip_line(&x->at.reader);
  const bool looks_for_else = x->condition.kind == CONDITION_IF && x->at.loop_count == 0;
  (void)executor_end_line(x);
  if (looks_for_else && is_key(x, KEY_ELSE)) {
    x->at.line = x->at.reader.offset;
    (void)advance(x, 1);
  }
  return EXECUTED_LINE;
}

static enum executed decide(struct executor* x, bool is_true) {
  const uint32_t target = reader_link(&x->at.reader, x->at.reader.offset);
  x->at.begun = false;
  x->at.in_line = true;
  if (!reader_advance(&x->at.reader, 1)) return decide_line(x, is_true);
  if (is_true) return executor_end_line(x);
  return target == LINK_NONE ? executor_fail(x, RUN_TIME_BLOCK) : executor_jump(x, target);
}

/* AND binds tighter than OR, between brackets as inside of them. */
static enum executed condition(struct executor* x, const struct instruction* in) {
  double a, b;
  if (x->at.reader.rotary || !evaluator_pop(&x->evaluator, &b) || !evaluator_pop(&x->evaluator, &a))
    return EXECUTED_ERROR;
  const bool term = compare(in->number & CONDITION_COMPARATOR, a, b);
  if (in->group == CONDITION_INNER_AND) {
    x->condition.inner_all = x->condition.inner_all && term;
  } else if (in->group == CONDITION_INNER_OR) {
    x->condition.inner_any = x->condition.inner_any || x->condition.inner_all;
    x->condition.inner_all = term;
  } else {
    const bool continues = in->group == CONDITION_AND || in->group == CONDITION_OR;
    if (continues != x->condition.open) return executor_fail(x, RUN_TIME_BLOCK);
    if (!continues) x->condition.kind = in->group;
    if (in->group != CONDITION_AND) {
      x->condition.any = continues && (x->condition.any || x->condition.all);
      x->condition.all = true;
    }
    x->condition.inner_any = false;
    x->condition.inner_all = term;
  }
  if ((in->number & CONDITION_MORE) != 0) return advance(x, 1);
  x->condition.all = x->condition.all && (x->condition.inner_any || x->condition.inner_all);
  if (reader_link(&x->at.reader, x->at.reader.offset) == LINK_CONTINUES) {
    (void)reader_advance(&x->at.reader, 1); /* the next line, in a PLC, belongs to this one */
    x->condition.open = x->at.in_line = true;
    return EXECUTED_WORD;
  }
  x->condition.open = false;
  return decide(x, x->condition.any || x->condition.all);
}

/* Met behind what its IF governs, so nothing of it is executed. */
static enum executed skip_else(struct executor* x) {
  const uint32_t target = reader_link(&x->at.reader, x->at.reader.offset);
  if (reader_advance(&x->at.reader, 1))
    return target == LINK_NONE ? executor_fail(x, RUN_TIME_BLOCK) : executor_jump(x, target);
  reader_skip_line(&x->at.reader);
  return executor_end_line(x);
}

static enum executed statement(struct executor* x, const struct instruction* in) {
  uint32_t target;
  if (x->at.reader.rotary) return EXECUTED_STATEMENT;
  switch (in->number) {
    case KEY_ELSE:
      return skip_else(x);
    case KEY_ENDIF:
      return end_statement(x, 1);
    case KEY_ENDWHILE:
      target = reader_link(&x->at.reader, x->at.reader.offset);
      return target == LINK_NONE ? executor_fail(x, RUN_TIME_BLOCK) : executor_jump(x, target - 1u);
    case KEY_RETURN:
      return EXECUTED_END;
    default:
      return EXECUTED_STATEMENT;
  }
}

static enum executed assign(struct executor* x, const struct instruction* in) {
  double value = in->value, number = (double)(in->number + x->prefix);
  if (in->operation != OP_ASSIGN && !evaluator_pop(&x->evaluator, &value)) return EXECUTED_ERROR;
  if (in->operation == OP_ASSIGN_INDEXED && !evaluator_pop(&x->evaluator, &number)) return EXECUTED_ERROR;
  slice_pause();
  variable_write(in->group, x->cs, number, value); /* a line whose work is seen is told at once, so without a pause */
  return end_statement(x, 1);
}

static enum executed evaluate(struct executor* x, const struct instruction* in, word48_t head) {
  const uint32_t raw_count = word_raw_count(in);
  word48_t raw = 0;
  if (raw_count != 0 && reader_peek(&x->at.reader, 1, &raw) != READER_WORD) return EXECUTED_ERROR;
  x->prefix = 0;
  if (!evaluator_execute(&x->evaluator, in, head, raw, x->cs)) return EXECUTED_ERROR;
  slice_pause();
  return advance(x, 1u + raw_count);
}

/* The operations whose value was pushed before them. */
static bool pops(const struct instruction* in) {
  return in->operation == OP_AXIS_POP || in->operation == OP_RATE_POP || in->operation == OP_STATEMENT_POP ||
         in->operation == OP_SYNCHRONOUS || in->operation == OP_SYNCHRONOUS_INDEXED;
}

static void begin_word(struct executor* x, word48_t head) {
  const uint32_t offset = reader_offset(&x->at.reader);
  if ((head & WORD_START_OF_LINE) != 0) x->at.line = offset;
  if (!x->at.begun) x->at.statement = offset;
  x->at.begun = true;
}

enum executed executor_step(struct executor* x, struct instruction* in) {
  word48_t head;
  switch (reader_peek(&x->at.reader, 0, &head)) {
    case READER_WORD:
      break;
    case READER_LATER:
      return EXECUTED_LATER;
    case READER_END:
      return EXECUTED_END;
    default:
      return EXECUTED_ERROR;
  }
  *in = word_decode(head);
  begin_word(x, head);
  slice_pause(); /* to find it takes as long as to do it */
  if (in->operation >= OP_PUSH && in->operation <= OP_APPLY) return evaluate(x, in, head);
  switch (in->operation) {
    case OP_ILLEGAL:
      return EXECUTED_ERROR;
    case OP_BLANK:
      return end_statement(x, 1);
    case OP_PREFIX:
      x->prefix = in->number << 10;
      return advance(x, 1);
    case OP_ASSIGN:
    case OP_ASSIGN_POP:
    case OP_ASSIGN_INDEXED:
      return assign(x, in);
    case OP_CONDITION:
      return condition(x, in);
    case OP_STATEMENT:
      return statement(x, in);
    default:
      if (!pops(in)) return EXECUTED_STATEMENT;
      if (x->evaluator.depth == 0) return EXECUTED_ERROR;
      in->value = x->evaluator.stack[x->evaluator.depth - 1u];
      return EXECUTED_STATEMENT;
  }
}

/* What has been done must not be met again: when programs have just moved, this waits until the word can be read. */
enum executed executor_pass(struct executor* x) {
  word48_t head;
  enum reader_result found;
  while ((found = reader_peek(&x->at.reader, 0, &head)) == READER_LATER) slice_pause();
  if (found != READER_WORD) return EXECUTED_ERROR;
  const struct instruction in = word_decode(head);
  x->evaluator.depth = 0;
  return end_statement(x, 1u + word_raw_count(&in));
}

bool executor_next(struct executor* x, struct instruction* in) {
  word48_t word;
  for (uint32_t ahead = 0; reader_peek(&x->at.reader, ahead, &word) == READER_WORD; ahead += 1u + word_raw_count(in)) {
    if (ahead != 0 && (word & WORD_START_OF_LINE) != 0) return false;
    *in = word_decode(word);
    if (in->operation < OP_PUSH || in->operation > OP_APPLY) return true;
    slice_pause();
  }
  return false;
}

bool executor_text_word(struct executor* x, uint32_t index, word48_t* word) {
  return reader_peek(&x->at.reader, 1u + index, word) == READER_WORD;
}
