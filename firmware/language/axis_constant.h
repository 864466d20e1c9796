/* Axis letters with decimal constants: what most program lines are made of, compiled the shortest way. */
#ifndef FIRMWARE_LANGUAGE_AXIS_CONSTANT_H
#define FIRMWARE_LANGUAGE_AXIS_CONSTANT_H

#include "firmware/language/lexer.h"
#include "firmware/language/word.h"

/* Compiles such statements from *at on, as statement_compile does, until it is at `boundary` or behind it, `most` words
 * are made, or something else stands there, as a constant that takes floating-point arithmetic. Returns the number of
 * words; *at is behind the last statement. `boundary`: a character that is part of no number, or
 * beyond the text; 0: none, the text ends with NUL. */
uint32_t axis_constants(const char** at, const char* boundary, word48_t* words, uint32_t most);

#endif
