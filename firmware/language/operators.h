/* Operators and functions of expressions: numbers stored in program words (OP_APPLY), spelling and precedence. */
#ifndef FIRMWARE_LANGUAGE_OPERATORS_H
#define FIRMWARE_LANGUAGE_OPERATORS_H

#include <stdint.h>

enum operator_code {
  OPERATOR_ADD,
  OPERATOR_SUBTRACT,
  OPERATOR_OR,
  OPERATOR_XOR, /* lower precedence */
  OPERATOR_MULTIPLY,
  OPERATOR_DIVIDE,
  OPERATOR_MODULO,
  OPERATOR_AND, /* higher */
  OPERATOR_BINARY_COUNT,
  OPERATOR_NEGATE = OPERATOR_BINARY_COUNT,
  OPERATOR_SIN,
  OPERATOR_COS,
  OPERATOR_TAN,
  OPERATOR_ASIN,
  OPERATOR_ACOS,
  OPERATOR_ATAN,
  OPERATOR_ATAN2,
  OPERATOR_LN,
  OPERATOR_EXP,
  OPERATOR_SQRT,
  OPERATOR_ABS,
  OPERATOR_INT,
  OPERATOR_COUNT
};

double operator_binary(uint32_t code, double a, double b);
double operator_unary(uint32_t code, double a, uint32_t cs); /* I15 selects degrees; ATAN2 takes Q0 of `cs` as its x */

#endif
