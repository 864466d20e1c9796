/* The text is written from a stack of what is still to come, not by recursion, so that the stack need is known. */
#include "firmware/language/expression_text.h"

#include "firmware/language/constant_text.h"
#include "firmware/language/expression.h"
#include "firmware/language/operators.h"

/* Each node is held once, with two brackets and an operator at most. */
enum { TO_COME = 4 * EXPRESSION_TEXT_NODES };

/* Node number, or minus a character. */
struct pending {
  uint32_t count;
  int16_t items[TO_COME];
};

static void hold(struct pending* p, int item) { p->items[p->count++] = (int16_t)item; }

struct instruction expression_text_operation(const struct expression_text* x, uint32_t node, double* value) {
  const uint32_t at = x->at[node];
  struct instruction in = word_decode(x->words[at]);
  *value = in.operation == OP_PUSH_DOUBLE ? word_double_join(x->words[at], x->words[at + 1]) : in.value;
  return in;
}

static bool is_binary(const struct instruction* in) {
  return in->operation == OP_APPLY && in->number < OPERATOR_BINARY_COUNT;
}

bool expression_text_add(struct expression_text* x, uint32_t at) {
  const struct instruction in = word_decode(x->words[at]);
  const uint32_t node = x->count;
  if (node >= EXPRESSION_TEXT_NODES) return false;
  uint32_t first = node;
  switch (in.operation) {
    case OP_PUSH:
    case OP_PUSH_DOUBLE:
    case OP_PUSH_VARIABLE:
      break;
    case OP_PUSH_INDEXED:
    case OP_APPLY:
      if (node == 0) return false;
      first = x->first[node - 1];
      if (is_binary(&in)) {
        if (first == 0) return false;
        first = x->first[first - 1];
      }
      break;
    default:
      return false;
  }
  x->at[node] = (uint16_t)at;
  x->first[node] = (uint16_t)first;
  x->count++;
  return true;
}

bool expression_text_last(const struct expression_text* x, uint32_t* root) {
  *root = x->count - 1u;
  return x->count != 0;
}

bool expression_text_before(const struct expression_text* x, uint32_t root, uint32_t* before) {
  *before = x->first[root] - 1u;
  return x->first[root] != 0;
}

enum level { LEVEL_SUM, LEVEL_PRODUCT, LEVEL_NEGATED, LEVEL_ATOM };

static enum level level_of(const struct expression_text* x, uint32_t node) {
  double value;
  const struct instruction in = expression_text_operation(x, node, &value);
  if (in.operation != OP_APPLY || in.number > OPERATOR_NEGATE) return LEVEL_ATOM;
  if (in.number == OPERATOR_NEGATE) return LEVEL_NEGATED;
  return in.number >= OPERATOR_MULTIPLY ? LEVEL_PRODUCT : LEVEL_SUM;
}

static void hold_bracketed(struct pending* p, uint32_t node, bool bracketed) {
  if (bracketed) hold(p, -')');
  hold(p, (int)node);
  if (bracketed) hold(p, -'(');
}

static bool is_constant(const struct expression_text* x, uint32_t node) {
  double value;
  const struct instruction in = expression_text_operation(x, node, &value);
  return in.operation == OP_PUSH || in.operation == OP_PUSH_DOUBLE;
}

static void put_text(const char* text, void (*put)(char c)) {
  while (*text != '\0') put(*text++);
}

static void put_operator(const struct expression_text* x, uint32_t node, uint32_t code, struct pending* p,
                         void (*put)(char c)) {
  const char* name = expression_operator_name(code);
  if (name == 0) name = "?";
  if (code < OPERATOR_BINARY_COUNT) { /* equal levels go left to right: a right operand needs brackets */
    const uint32_t left = x->first[node - 1] - 1u;
    hold_bracketed(p, node - 1, level_of(x, node - 1) <= level_of(x, node));
    hold(p, -*name);
    hold_bracketed(p, left, level_of(x, left) < level_of(x, node));
  } else if (code == OPERATOR_NEGATE) { /* `-5` would be a constant */
    put('-');
    hold_bracketed(p, node - 1, level_of(x, node - 1) < LEVEL_NEGATED || is_constant(x, node - 1));
  } else {
    put_text(name, put);
    hold_bracketed(p, node - 1, true);
  }
}

static void put_node(const struct expression_text* x, uint32_t node, struct pending* p, void (*put)(char c)) {
  double value;
  const struct instruction in = expression_text_operation(x, node, &value);
  switch (in.operation) {
    case OP_APPLY:
      put_operator(x, node, in.number, p, put);
      break;
    case OP_PUSH_VARIABLE:
      put(expression_classes[in.group % VARIABLE_CLASSES]);
      integer_text(in.number, put);
      break;
    case OP_PUSH_INDEXED:
      put(expression_classes[in.group % VARIABLE_CLASSES]);
      hold_bracketed(p, node - 1, true);
      break;
    default:
      constant_text(&in, value, put);
      break;
  }
}

void expression_text_put(const struct expression_text* x, uint32_t root, void (*put)(char c)) {
  struct pending p;
  p.count = 0;
  hold(&p, (int)root);
  while (p.count != 0) {
    const int item = p.items[--p.count];
    if (item < 0)
      put((char)-item);
    else
      put_node(x, (uint32_t)item, &p, put);
  }
}
