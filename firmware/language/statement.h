/* Compiler of single program statements to 48-bit words. */
#ifndef FIRMWARE_LANGUAGE_STATEMENT_H
#define FIRMWARE_LANGUAGE_STATEMENT_H

#include "firmware/language/expression.h"
#include "firmware/language/statement_table.h"

/* How a statement begins. `index`: class of the variable, or row of the statement table. */
enum statement_kind { STATEMENT_NONE, STATEMENT_ASSIGNMENT, STATEMENT_ROW };
struct statement {
  enum statement_kind kind;
  uint32_t index;
};

/* Consumes the head; NONE: nothing is consumed. `where`: the kind of program (enum statement_where), 0 on line, with
 * WHERE_BEGUN and WHERE_CALLED as far as they are true for the line. A statement that does not belong there is found,
 * so that it can be refused, unless it means something else there. */
struct statement statement_find(struct lexer* lx, uint32_t where);
bool statement_starts(struct lexer lx); /* on line */
/* What follows the head. ERR003: no such statement in this kind of program, or not well formed. */
error_t statement_compile(struct lexer* lx, struct statement head, uint32_t where, struct word_list* out);

#endif
