/* The stack machine that executes compiled expressions, on-line in the background task and for programs in the
 * real-time task. */
#include "firmware/language/evaluator.h"

#include "firmware/base/dimensions.h"
#include "firmware/base/mathematics.h"
#include "firmware/language/operators.h"
#include "firmware/variables/i_variables.h"
#include "firmware/variables/m_variables.h"
#include "firmware/variables/pq_variables.h"

#define BELOW_A_FLOAT48 UINT64_C(0x3FFFF) /* of the 53 bits of a double */
#define HALF_A_FLOAT48 UINT64_C(0x20000)
#define EXPONENT_MASK UINT64_C(0x7FF0000000000000)
#define FRACTION_MASK UINT64_C(0x000FFFFFFFFFFFFF)

uint32_t variable_index(double number) { return (uint32_t)math_to_integer(number) % VARIABLE_COUNT; }

static double variable_read(uint32_t group, uint32_t cs, double number) {
  uint32_t index = variable_index(number);
  switch (group) {
    case VARIABLE_M:
      return m_variable_read(index);
    case VARIABLE_P:
      return p_variable_read(index);
    case VARIABLE_Q:
      return q_variable_read(cs, index);
    default:
      return i_variable_read(index);
  }
}

void variable_write(uint32_t group, uint32_t cs, double number, double value) {
  uint32_t index = variable_index(number);
  switch (group) {
    case VARIABLE_M:
      m_variable_write(index, value);
      break;
    case VARIABLE_P:
      p_variable_write(index, value);
      break;
    case VARIABLE_Q:
      q_variable_write(cs, index, value);
      break;
    default:
      i_variable_write(index, value);
      break;
  }
}

static double operator_binary(uint32_t code, double a, double b) {
  switch (code) {
    case OPERATOR_ADD:
      return a + b;
    case OPERATOR_SUBTRACT:
      return a - b;
    case OPERATOR_MULTIPLY:
      return a * b;
    case OPERATOR_DIVIDE:
      return math_divide(a, b);
    case OPERATOR_MODULO:
      return math_modulo(a, b);
    case OPERATOR_AND:
      return math_bitwise(MATH_AND, a, b);
    case OPERATOR_OR:
      return math_bitwise(MATH_OR, a, b);
    default:
      return math_bitwise(MATH_XOR, a, b);
  }
}

/* I15 selects degrees; ATAN2 takes Q0 of `cs` as its x. */
static double operator_unary(uint32_t code, double a, uint32_t cs) {
  int degrees = i_integer(I15_RADIANS) == 0;
  switch (code) {
    case OPERATOR_NEGATE:
      return -a;
    case OPERATOR_SIN:
      return math_sine(a, degrees);
    case OPERATOR_COS:
      return math_cosine(a, degrees);
    case OPERATOR_TAN:
      return math_tangent(a, degrees);
    case OPERATOR_ASIN:
      return math_arc_sine(a, degrees);
    case OPERATOR_ACOS:
      return math_arc_cosine(a, degrees);
    case OPERATOR_ATAN:
      return math_arc_tangent(a, degrees);
    case OPERATOR_ATAN2:
      return math_arc_tangent2(a, q_variable_read(cs, 0), degrees);
    case OPERATOR_LN:
      return math_logarithm(a);
    case OPERATOR_EXP:
      return math_exponential(a);
    case OPERATOR_SQRT:
      return math_square_root(a);
    case OPERATOR_ABS:
      return math_absolute(a);
    default:
      return math_floor(a);
  }
}

/* Only numbers come to the stack, so nothing that takes one has to look: beyond the largest there is the largest, where
 * nothing is defined 0. They have the 35 bits that a variable has, half up: the controller has no other numbers. */
static double number_of(double value) {
  union {
    double value;
    uint64_t bits;
  } u = {value};
  if ((u.bits & BELOW_A_FLOAT48) == 0 && (~u.bits & EXPONENT_MASK) != 0) return value;
  if ((~u.bits & EXPONENT_MASK) != 0) u.bits = (u.bits + HALF_A_FLOAT48) & ~BELOW_A_FLOAT48;
  if ((~u.bits & EXPONENT_MASK) != 0) return u.value;
  u.bits = (u.bits & FRACTION_MASK) != 0 ? 0 : u.bits - 1u - BELOW_A_FLOAT48;
  return u.value;
}

static bool push(struct evaluator* ev, double value) {
  if (ev->depth >= EXPRESSION_DEPTH) return false;
  ev->stack[ev->depth++] = number_of(value);
  return true;
}

bool evaluator_pop(struct evaluator* ev, double* value) {
  if (ev->depth == 0) return false;
  *value = ev->stack[--ev->depth];
  return true;
}

static bool apply(struct evaluator* ev, uint32_t code, uint32_t cs) {
  double a, b;
  if (code >= OPERATOR_COUNT || !evaluator_pop(ev, &b)) return false;
  if (code >= OPERATOR_BINARY_COUNT) return push(ev, operator_unary(code, b, cs));
  return evaluator_pop(ev, &a) && push(ev, operator_binary(code, a, b));
}

bool evaluator_execute(struct evaluator* ev, const struct instruction* in, word48_t head, word48_t raw, uint32_t cs) {
  double number;
  switch (in->operation) {
    case OP_PUSH:
      return push(ev, in->value);
    case OP_PUSH_DOUBLE:
      return push(ev, word_double_join(head, raw));
    case OP_PUSH_VARIABLE:
      return push(ev, variable_read(in->group, cs, (double)in->number));
    case OP_PUSH_INDEXED:
      return evaluator_pop(ev, &number) && push(ev, variable_read(in->group, cs, number));
    case OP_APPLY:
      return apply(ev, in->number, cs);
    default:
      return false;
  }
}
