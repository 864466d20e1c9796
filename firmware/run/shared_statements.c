#include "firmware/run/shared_statements.h"

#include "firmware/language/statement_argument.h"
#include "firmware/language/statement_key.h"
#include "firmware/motion/phase_search.h"
#include "firmware/run/plc_control.h"

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
    default:
      return OUTPUT_ILLEGAL;
  }
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
    case OP_STATEMENT: /* nobody waits at a lock: its state would go to a variable, which this syntax does not have */
    case OP_STATEMENT_POP:
      return in->number == KEY_LOCK || in->number == KEY_UNLOCK ? OUTPUT_DONE : OUTPUT_ILLEGAL;
    default:
      return OUTPUT_ILLEGAL;
  }
}
