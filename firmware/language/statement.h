/* Compiler of single program statements to 48-bit words. */
#ifndef FIRMWARE_LANGUAGE_STATEMENT_H
#define FIRMWARE_LANGUAGE_STATEMENT_H

#include "firmware/language/expression.h"

/* How a statement begins; OTHER: one of fixed programs. `index`: axis, class of the variable, or keyword. */
enum statement_kind {
  STATEMENT_NONE,
  STATEMENT_AXIS,
  STATEMENT_FEED,
  STATEMENT_ASSIGNMENT,
  STATEMENT_KEYWORD,
  STATEMENT_OTHER
};
struct statement {
  enum statement_kind kind;
  uint32_t index;
};

struct statement statement_find(struct lexer* lx); /* consumes the head; NONE: nothing is consumed */
bool statement_starts(struct lexer lx);
/* What follows the head. ERR003: not a statement that a rotary buffer takes. */
error_t statement_compile(struct lexer* lx, struct statement head, struct word_list* out);
error_t statement_axis_list(struct lexer* lx, uint32_t bare,
                            uint32_t* mask);                   /* `(X,Y,R)` behind ABS, INC, FRAX; none: `bare` */
error_t statement_frax_list(struct lexer* lx, uint32_t* mask); /* behind FRAX */

#endif
