/* Expressions (firmware.md 1.7): compiled to 48-bit words, the same for on-line use and inside program lines. */
#ifndef FIRMWARE_LANGUAGE_EXPRESSION_H
#define FIRMWARE_LANGUAGE_EXPRESSION_H

#include "firmware/language/lexer.h"

/* Parses and evaluates at once. `cs` (0..15) gives the Q-variables. */
error_t expression_evaluate(struct lexer *lx, uint32_t cs, double *value);

#endif
