/* Compiler of what stands behind a statement's head, by the kind of argument in the statement table. */
#ifndef FIRMWARE_LANGUAGE_STATEMENT_ARGUMENT_H
#define FIRMWARE_LANGUAGE_STATEMENT_ARGUMENT_H

#include "firmware/language/expression.h"
#include "firmware/language/statement_table.h"

enum { LABEL_LIMIT = 262143 };
#define DISPLAY_VALUE WORD_KEY(9, 1, 10) /* DISPLAY of a value; that of a text is in the table */
enum { DISPLAY_COLUMNS = 80, DISPLAY_WIDTH_BIT = 8, DISPLAY_DECIMALS_BIT = 16 };
#define LOCK_TELLING WORD_KEY(9, 1, 12) /* LOCK with the P-variable that it tells; without one it is in the table */
enum { LOCK_COUNT = 8, LOCK_VARIABLE_BIT = 3 };
error_t statement_lock(struct lexer* lx, uint32_t* number); /* of the lock, and above it that of the variable */

/* ADDRESS names a motor, a coordinate system or both; 0: not named. A part is a number, or with ADDRESS_VARIABLE that
 * of the P-variable which holds it. In the statement's word they lie as `statement_address` puts them. */
enum { ADDRESS_VARIABLE = 0x2000 };
uint32_t statement_address(uint32_t motor, uint32_t cs);
uint32_t statement_address_motor(uint32_t number);
uint32_t statement_address_cs(uint32_t number);

error_t statement_axis_compile(struct lexer* lx, uint32_t axis, struct word_list* out); /* most of all arguments */
error_t statement_argument_compile(struct lexer* lx, const struct statement_row* row, struct word_list* out);

#endif
