/* Text of a compiled expression: the stack program back to infix, with the brackets that it needs and no others. */
#ifndef FIRMWARE_LANGUAGE_EXPRESSION_TEXT_H
#define FIRMWARE_LANGUAGE_EXPRESSION_TEXT_H

#include "firmware/language/word.h"

enum { EXPRESSION_TEXT_NODES = 300 }; /* as many as words in a line */

/* The operations of one statement, in their order. The operands of operation i end with operation i - 1, and with the
 * one before `first` of that. */
struct expression_text {
  const word48_t* words;
  uint32_t count;
  uint16_t at[EXPRESSION_TEXT_NODES];    /* its word */
  uint16_t first[EXPRESSION_TEXT_NODES]; /* operation with which its operands begin */
};

/* Takes the operation at word `at`. False: none of an expression, or it has no operands. */
bool expression_text_add(struct expression_text* x, uint32_t at);
/* Root of the last value of the statement, and of the one before `root`; false: there is none. */
bool expression_text_last(const struct expression_text* x, uint32_t* root);
bool expression_text_before(const struct expression_text* x, uint32_t root, uint32_t* before);
struct instruction expression_text_operation(const struct expression_text* x, uint32_t node, double* value);
void expression_text_put(const struct expression_text* x, uint32_t root, void (*put)(char c));

#endif
