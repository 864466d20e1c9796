/* Constants of program words as text that is read back to the same word. */
#ifndef FIRMWARE_LANGUAGE_CONSTANT_TEXT_H
#define FIRMWARE_LANGUAGE_CONSTANT_TEXT_H

#include "firmware/language/word.h"

/* The constant of OP_PUSH, OP_PUSH_DOUBLE, OP_ASSIGN and OP_STATEMENT is exact, that of OP_AXIS and OP_RATE has been
 * rounded to the word. */
void constant_text(const struct instruction* in, double value, void (*put)(char c));
void integer_text(uint64_t value, void (*put)(char c));

#endif
