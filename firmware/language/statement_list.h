/* Lists of axes and numbers, as statements and on-line commands have them. */
#ifndef FIRMWARE_LANGUAGE_STATEMENT_LIST_H
#define FIRMWARE_LANGUAGE_STATEMENT_LIST_H

#include "firmware/language/lexer.h"

/* `(X,Y,R)` behind ABS and INC; none: `bare`. A bit an axis, AXIS_VECTOR for R. */
error_t statement_axis_list(struct lexer* lx, uint32_t bare, uint32_t* mask);
error_t statement_frax_list(struct lexer* lx, uint32_t* mask); /* `(X,Y)` behind FRAX; none: X, Y and Z */
/* `1,3..5`, all from `first` to `last`; bit 0 is `first`. */
error_t statement_number_list(struct lexer* lx, int32_t first, int32_t last, uint32_t* mask);

#endif
