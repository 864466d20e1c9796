/* Compiler of single program statements to 48-bit words. */
#ifndef FIRMWARE_LANGUAGE_STATEMENT_H
#define FIRMWARE_LANGUAGE_STATEMENT_H

#include "firmware/language/expression.h"

bool statement_starts(struct lexer lx);
bool statement_axis_starts(struct lexer* lx, uint32_t* axis); /* an axis letter with a value: consumes the letter */
error_t statement_axis_compile(struct lexer* lx, uint32_t axis, struct word_list* out); /* its value */
error_t statement_compile(struct lexer* lx,
                          struct word_list* out); /* ERR003: not a statement that a rotary buffer takes */
error_t statement_axis_list(struct lexer* lx, uint32_t bare,
                            uint32_t* mask);                   /* `(X,Y,R)` behind ABS, INC, FRAX; none: `bare` */
error_t statement_frax_list(struct lexer* lx, uint32_t* mask); /* behind FRAX */

#endif
