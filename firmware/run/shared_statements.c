#include "firmware/run/shared_statements.h"

#include "firmware/language/statement_argument.h"
#include "firmware/language/statement_key.h"
#include "firmware/motion/phase_search.h"
#include "firmware/run/plc_control.h"
#include "firmware/run/process_locks.h"
#include "firmware/variables/pq_variables.h"

enum { LONGEST_TEXT_WORDS = (TEXT_LENGTH + WORD_TEXT_CHARACTERS - 1) / WORD_TEXT_CHARACTERS };

static enum program_output list(struct executor* x, const struct instruction* in) {
  double value;
  switch (in->group) {
    case KEY_ENABLE_PLC:
      plc_enable(in->number);
      return OUTPUT_DONE;
    case KEY_DISABLE_PLC:
      plc_disable(in->number);
      return OUTPUT_DONE;
    case KEY_PAUSE_PLC:
      plc_pause(in->number);
      return OUTPUT_DONE;
    case KEY_RESUME_PLC:
      plc_resume(in->number);
      return OUTPUT_DONE;
    case KEY_ENABLE_PLCC: /* compiled PLCs cannot be loaded */
    case KEY_DISABLE_PLCC:
      return OUTPUT_DONE;
    case KEY_SETPHASE:
      phasing_set_here(in->number);
      return OUTPUT_DONE;
    case DISPLAY_VALUE:
      if (!evaluator_pop(&x->evaluator, &value)) return OUTPUT_ILLEGAL;
      program_output_value(in, value);
      return OUTPUT_DONE;
    case LOCK_TELLING:
      p_variable_write(in->number >> LOCK_VARIABLE_BIT, process_lock(in->number & (LOCK_COUNT - 1u)) ? 1.0 : 0.0);
      return OUTPUT_DONE;
    default:
      return OUTPUT_ILLEGAL;
  }
}

static enum program_output lock(const struct instruction* in) {
  if (in->number != KEY_LOCK && in->number != KEY_UNLOCK) return OUTPUT_ILLEGAL;
  if (!(in->value >= 0.0 && in->value < (double)LOCK_COUNT)) return OUTPUT_DONE; /* there is no such lock */
  if (in->number == KEY_LOCK)
    (void)process_lock((uint32_t)in->value);
  else
    process_unlock((uint32_t)in->value);
  return OUTPUT_DONE;
}

static enum program_output text(struct executor* x, const struct instruction* in, const struct program_caller* caller) {
  word48_t raw[LONGEST_TEXT_WORDS];
  const uint32_t count = word_raw_count(in);
  for (uint32_t i = 0; i < count; i++)
    if (!executor_text_word(x, i, &raw[i])) return OUTPUT_ILLEGAL;
  return program_output_text(in, raw, caller);
}

enum program_output shared_statement(struct executor* x, const struct instruction* in,
                                     const struct program_caller* caller) {
  switch (in->operation) {
    case OP_LIST:
      return list(x, in);
    case OP_TEXT:
      return text(x, in, caller);
    case OP_STATEMENT:
    case OP_STATEMENT_POP:
      return lock(in);
    default:
      return OUTPUT_ILLEGAL;
  }
}
