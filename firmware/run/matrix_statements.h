/* TSELECT, TINIT, ADIS, IDIS, AROT, IROT (motion:8.2). Real-time task, in slices. */
#ifndef FIRMWARE_RUN_MATRIX_STATEMENTS_H
#define FIRMWARE_RUN_MATRIX_STATEMENTS_H

#include "firmware/run/motion_program.h"

bool matrix_statement_is(const struct instruction* in); /* axes that stand before it on its line move first */
/* ERROR: there is no such matrix, or none is selected. STATEMENT: it is something else. */
enum executed matrix_statement(uint32_t cs, const struct instruction* in);

#endif
