/* Compiler of what stands behind a statement's head, by the kind of argument in the statement table. */
#ifndef FIRMWARE_LANGUAGE_STATEMENT_ARGUMENT_H
#define FIRMWARE_LANGUAGE_STATEMENT_ARGUMENT_H

#include "firmware/language/expression.h"
#include "firmware/language/statement_table.h"

enum { LABEL_LIMIT = 262143 };
#define DISPLAY_VALUE WORD_KEY(9, 1, 10) /* DISPLAY of a value; that of a text is in the table */
enum { DISPLAY_COLUMNS = 80, DISPLAY_WIDTH_BIT = 8, DISPLAY_DECIMALS_BIT = 16 };

error_t statement_axis_compile(struct lexer* lx, uint32_t axis, struct word_list* out); /* most of all arguments */
error_t statement_argument_compile(struct lexer* lx, const struct statement_row* row, struct word_list* out);

#endif
