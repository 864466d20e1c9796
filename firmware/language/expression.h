/* Expressions (firmware:1.7): compiled to 48-bit words, the same for on-line use and inside program lines.
 * The words are a stack program in postfix order, one word a token; parentheses cost nothing, a constant that 33 bits
 * do not hold exactly costs two words. */
#ifndef FIRMWARE_LANGUAGE_EXPRESSION_H
#define FIRMWARE_LANGUAGE_EXPRESSION_H

#include "firmware/language/lexer.h"
#include "firmware/language/word.h"

struct word_list {
  word48_t* words;
  uint32_t count, capacity;
};

/* Parses and evaluates at once. `cs` (0..15) gives the Q-variables. */
error_t expression_evaluate(struct lexer* lx, uint32_t cs, double* value);

extern const char expression_classes[];              /* letters of the variables in the order of enum variable_class */
const char* expression_operator_name(uint32_t code); /* of an operator or function; 0: there is none */

/* Appends a stack program that leaves one value. `bracketed`: the text starts with `(` and ends with the matching `)`.
 */
error_t expression_compile(struct lexer* lx, bool bracketed, struct word_list* out);
/* ERR_DATA when the list is full: line too long. */
error_t word_list_add_instruction(struct word_list* list, const struct instruction* in);
error_t word_list_add_constant(struct word_list* list, double exact, bool hexadecimal); /* rounded to a 48-bit float */
error_t word_list_add(struct word_list* list, word48_t word);

#endif
