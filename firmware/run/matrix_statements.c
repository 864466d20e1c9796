#include "firmware/run/matrix_statements.h"

#include "firmware/language/statement_key.h"
#include "firmware/motion/axis_matrix.h"

bool matrix_statement_is(const struct instruction* in) {
  if (in->operation != OP_STATEMENT && in->operation != OP_STATEMENT_POP) return false;
  return in->number == KEY_TINIT || in->number - KEY_ADIS <= KEY_TSELECT - KEY_ADIS;
}

static bool execute(uint32_t cs, const struct instruction* in) {
  switch (in->number) {
    case KEY_TSELECT:
      return axis_matrix_select(cs, in->value);
    case KEY_TINIT:
      return axis_matrix_change(cs, MATRIX_TINIT, 0.0);
    case KEY_ADIS:
      return axis_matrix_change(cs, MATRIX_ADIS, in->value);
    case KEY_IDIS:
      return axis_matrix_change(cs, MATRIX_IDIS, in->value);
    case KEY_AROT:
      return axis_matrix_change(cs, MATRIX_AROT, in->value);
    default:
      return axis_matrix_change(cs, MATRIX_IROT, in->value);
  }
}

enum executed matrix_statement(uint32_t cs, const struct instruction* in) {
  if (!matrix_statement_is(in)) return EXECUTED_STATEMENT;
  return execute(cs, in) ? executor_pass(&motion_programs[cs].x) : EXECUTED_ERROR;
}
