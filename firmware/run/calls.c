#include "firmware/run/calls.h"

#include "firmware/base/mathematics.h"
#include "firmware/buffers/fixed_programs.h"
#include "firmware/kernel/slice.h"
#include "firmware/language/statement_argument.h"
#include "firmware/language/statement_key.h"

#define CALLS_END 32767.999995    /* behind label 99999 of PROG 32767, of which a 48-bit float has twenty bits */
#define LABELS_A_PROGRAM 100000.0 /* CALL 3.025: label 2500 */
#define LABELS_A_CODE 1000.0      /* G17.1: label 17100 */

enum {
  CODES_A_PROGRAM = 100,
  FIRST_CODE_PROGRAM = 1000, /* G0 to G99, and 1 more for M, 2 for T, 3 for D */
  CODE_PROGRAM_STEP = 10,    /* G100 to G199 */
  Q_SPINDLE = 127,
  Q_READ_MASK = 100
};

bool calls_split(double value, uint32_t* program, uint32_t* label) {
  if (!(value >= 0.0) || value >= CALLS_END) return false;
  *program = (uint32_t)value;
  *label = (uint32_t)((value - (double)*program) * LABELS_A_PROGRAM + 0.5);
  return true;
}

static bool is_label(const struct instruction* in, uint32_t label) {
  return in->operation == OP_STATEMENT && (in->number == KEY_N || in->number == KEY_O) && in->value == (double)label;
}

enum reader_result calls_find(uint32_t program, uint32_t label, struct program_entry* entry) {
  struct program_reader reader;
  word48_t word;
  enum reader_result found;
  *entry = program_top;
  if (label == 0) return reader_check(FIXED_PROG, program);
  reader_fixed(&reader, FIXED_PROG, program, 0);
  for (; (found = reader_peek(&reader, 0, &word)) == READER_WORD; slice_pause()) {
    const struct instruction in = word_decode(word);
    entry->offset = reader.offset;
    if ((word & WORD_START_OF_LINE) != 0) entry->line = reader.offset;
    if (is_label(&in, label)) return READER_WORD;
    reader.offset += 1u + word_raw_count(&in);
  }
  return found;
}

/* G154 is CALL 1010.54. False: no such code. */
static bool split_code(const struct instruction* in, uint32_t* program, uint32_t* label) {
  if (!(in->value >= 0.0) || in->value >= CALLS_END) return false;
  const uint32_t hundreds = (uint32_t)in->value / CODES_A_PROGRAM;
  *program = FIRST_CODE_PROGRAM + CODE_PROGRAM_STEP * hundreds + (in->number - KEY_G);
  *label = (uint32_t)((in->value - (double)(hundreds * CODES_A_PROGRAM)) * LABELS_A_CODE + 0.5);
  return true;
}

static bool is_code(const struct instruction* in) { return in->number >= KEY_G && in->number <= KEY_D; }

/* A program that was read to its end has no such label. */
static enum executed not_found(struct motion_program* p, uint32_t program, enum reader_result found) {
  if (found == READER_LATER) return EXECUTED_LATER;
  if (found == READER_END) return executor_fail(&p->x, RUN_TIME_LABEL);
  return executor_fail(&p->x, fixed_program_find(FIXED_PROG, program) != 0 ? RUN_TIME_BLOCK : RUN_TIME_PROGRAM);
}

/* The statement is passed when its target is known: an error leaves the program at it. PRELUDE has none. */
static enum executed call(struct motion_program* p, uint32_t program, uint32_t label, bool has_statement) {
  struct program_entry entry;
  if (p->depth == CALL_DEPTH) return executor_fail(&p->x, RUN_TIME_DEPTH);
  if (program == 0) return executor_fail(&p->x, RUN_TIME_PROGRAM);
  const enum reader_result found = calls_find(program, label, &entry);
  if (found != READER_WORD) return not_found(p, program, found);
  if (has_statement)
    (void)executor_pass(&p->x);
  else
    p->x.at.in_line = true; /* READ looks there, and it is no beginning any more */
  p->callers[p->depth++] = p->x.at;
  reader_fixed(&p->x.at.reader, FIXED_PROG, program, entry.offset);
  executor_begin(&p->x, p->x.cs);
  p->x.at.line = entry.line;
  return EXECUTED_LINE;
}

bool calls_return(struct motion_program* p) {
  if (p->depth == 0) return false;
  p->x.at = p->callers[--p->depth];
  p->labelled = false;
  return true;
}

static bool within(const struct motion_program* p, double value, uint32_t* label) {
  if (p->x.at.reader.rotary || !(value >= 0.0) || value > (double)LABEL_LIMIT) return false;
  *label = (uint32_t)value;
  return true;
}

static enum executed jump(struct motion_program* p, double value) {
  uint32_t label;
  struct program_entry entry;
  const uint32_t program = p->x.at.reader.number;
  if (!within(p, value, &label)) return executor_fail(&p->x, RUN_TIME_LABEL);
  const enum reader_result found = calls_find(program, label, &entry);
  if (found != READER_WORD) return not_found(p, program, found);
  p->x.at.line = entry.line;
  return executor_jump(&p->x, entry.offset);
}

/* Letter that a value of a calling line belongs to, 0 for A; 26: none. */
static uint32_t letter_of(const struct instruction* in) {
  static const char axes[] = "ABCUVWXYZ", vectors[] = "IJKR", codes[] = "GMTDS";
  const uint32_t n = in->number & 0x3FFu;
  char letter = 'Z' + 1;
  if (in->operation == OP_AXIS || in->operation == OP_AXIS_POP) {
    letter = axes[in->number];
  } else if (in->operation == OP_RATE || in->operation == OP_RATE_POP) {
    if (in->number == RATE_F) letter = 'F';
  } else if (in->operation == OP_STATEMENT || in->operation == OP_STATEMENT_POP) {
    if (in->number >> 10 == (KEY_G >> 10) && n >= 20u)
      letter = (char)('E' + (char)(n - 20u)); /* letters behind a call: E, H, L, P, Q */
    else if (in->number >> 10 == (KEY_G >> 10) && n < sizeof codes - 1)
      letter = codes[n];
    else if (in->number >> 10 == (WORD_KEY(1, 1, 0) >> 10) && n < sizeof vectors - 1)
      letter = vectors[n];
  }
  return letter > 'Z' ? 26u : (uint32_t)(letter - 'A');
}

/* READ(X,P): values behind the call, up to the first letter that is not listed; the caller goes on behind them. */
static enum executed read(struct motion_program* p, uint32_t letters) {
  struct instruction in;
  uint32_t found = 0;
  if (p->depth == 0) return executor_fail(&p->x, RUN_TIME_READ);
  const enum executed passed = executor_pass(&p->x);
  p->reader = p->x.at;
  p->x.at = p->callers[p->depth - 1u];
  p->reading = true;
  while (p->x.at.in_line && executor_next(&p->x, &in)) {
    const uint32_t letter = letter_of(&in);
    enum executed executed;
    if (letter >= 26u || (letters >> letter & 1u) == 0) break;
    while ((executed = executor_step(&p->x, &in)) == EXECUTED_WORD) slice_pause();
    if (executed != EXECUTED_STATEMENT) break; /* damaged: the caller meets it */
    variable_write(VARIABLE_Q, p->x.cs, (double)(Q_READ_MASK + 1u + letter), in.value);
    found |= 1u << letter;
    (void)executor_pass(&p->x);
  }
  motion_program_end_read(p);
  variable_write(VARIABLE_Q, p->x.cs, (double)Q_READ_MASK, (double)found);
  return passed;
}

static bool is_move(const struct instruction* in) {
  if (in->operation == OP_AXIS || in->operation == OP_AXIS_POP) return true;
  return (in->operation == OP_STATEMENT || in->operation == OP_STATEMENT_POP) && in->number >= KEY_ARC_VECTOR &&
         in->number < KEY_TRIGGER;
}

bool calls_prelude_is_due(struct motion_program* p) {
  struct instruction in;
  if (!p->prelude.on || p->depth != 0 || p->x.at.begun || (p->x.at.in_line && !p->labelled)) return false;
  return executor_next(&p->x, &in) && is_move(&in);
}

enum executed calls_prelude_call(struct motion_program* p) {
  uint32_t program, label;
  const struct instruction* in = &p->prelude.call;
  const bool known =
      in->number == KEY_CALL ? calls_split(in->value, &program, &label) : split_code(in, &program, &label);
  p->x.at.statement = reader_offset(&p->x.at.reader); /* it has not begun; nor has its line without labels */
  if (!p->x.at.in_line) p->x.at.line = p->x.at.statement;
  const enum executed called = known ? call(p, program, label, false) : executor_fail(&p->x, RUN_TIME_PROGRAM);
  if (called != EXECUTED_LATER) p->labelled = false;
  return called;
}

void calls_note_label(struct motion_program* p, enum executed executed, const struct instruction* in) {
  if (executed == EXECUTED_LATER) return;
  const bool label =
      executed == EXECUTED_STATEMENT && in->operation == OP_STATEMENT && (in->number == KEY_N || in->number == KEY_O);
  p->labelled = label && (!p->x.at.in_line || p->labelled);
}

bool calls_is_call(const struct instruction* in) {
  if (in->operation != OP_STATEMENT && in->operation != OP_STATEMENT_POP) return false;
  return is_code(in) || in->number == KEY_CALL || in->number == KEY_GOSUB || in->number == KEY_GOTO;
}

/* PRELUDE1 and the call behind it, which is not made now: CALL, G, M, T or D. An expression has the value of now. */
static enum executed prelude(struct motion_program* p, double value) {
  struct instruction in;
  p->prelude.on = false;
  if (value == 0.0) return executor_pass(&p->x);
  if (value != 1.0 || executor_pass(&p->x) != EXECUTED_WORD) return EXECUTED_ERROR;
  enum executed executed;
  while ((executed = executor_step(&p->x, &in)) == EXECUTED_WORD) slice_pause();
  if (executed != EXECUTED_STATEMENT || !calls_is_call(&in) || in.number == KEY_GOSUB || in.number == KEY_GOTO)
    return EXECUTED_ERROR;
  p->prelude.call = in;
  p->prelude.on = true;
  return executor_pass(&p->x);
}

enum executed calls_execute(struct motion_program* p, const struct instruction* in) {
  uint32_t program, label;
  if (in->operation == OP_LIST && in->group == KEY_READ) return read(p, in->number);
  if (in->operation != OP_STATEMENT && in->operation != OP_STATEMENT_POP) return EXECUTED_STATEMENT;
  if (is_code(in))
    return split_code(in, &program, &label) ? call(p, program, label, true) : executor_fail(&p->x, RUN_TIME_PROGRAM);
  switch (in->number) {
    case KEY_PRELUDE:
      return prelude(p, in->value);
    case KEY_N:
    case KEY_O:
      return executor_pass(&p->x);
    case KEY_S:
      variable_write(VARIABLE_Q, p->x.cs, (double)Q_SPINDLE, in->value);
      return executor_pass(&p->x);
    case KEY_GOTO:
      return jump(p, in->value);
    case KEY_GOSUB:
      return within(p, in->value, &label) ? call(p, p->x.at.reader.number, label, true)
                                          : executor_fail(&p->x, RUN_TIME_LABEL);
    case KEY_CALL:
      return calls_split(in->value, &program, &label) ? call(p, program, label, true)
                                                      : executor_fail(&p->x, RUN_TIME_PROGRAM);
    default:
      return EXECUTED_STATEMENT;
  }
}
