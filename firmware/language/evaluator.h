/* The stack machine that executes compiled expressions, and the variables as it reaches them. */
#ifndef FIRMWARE_LANGUAGE_EVALUATOR_H
#define FIRMWARE_LANGUAGE_EVALUATOR_H

#include "firmware/language/word.h"

enum { EXPRESSION_DEPTH = 65 }; /* values on the stack: `1+(1+(...` needs four characters of a line for each */

struct evaluator {
  double stack[EXPRESSION_DEPTH];
  uint32_t depth;
};

/* Executes one stack instruction; `raw` is the word after OP_PUSH_DOUBLE. False: not a stack instruction, or the stack
 * is misused, which only a corrupted buffer can bring about. */
bool evaluator_execute(struct evaluator* ev, const struct instruction* in, word48_t head, word48_t raw, uint32_t cs);
bool evaluator_pop(struct evaluator* ev, double* value);
uint32_t variable_index(double number); /* 0..8191; anything else wraps, as the address calculation would */
void variable_write(uint32_t group, uint32_t cs, double number, double value);

#endif
