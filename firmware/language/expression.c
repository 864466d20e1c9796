/* Compiler of expressions: operator precedence with an explicit stack instead of recursion, so that the stack need is
 * known. */
#include "firmware/language/expression.h"

#include "firmware/base/dimensions.h"
#include "firmware/base/float48.h"
#include "firmware/language/evaluator.h"
#include "firmware/language/operators.h"

/* No expression of a host line (255 characters) reaches these: an operator or bracket takes a character, so does a
 * word. */
enum { PENDING_LIMIT = 256, ON_LINE_WORDS = 260 };

enum pending_kind { PENDING_OPERATOR, PENDING_BRACKET, PENDING_FUNCTION, PENDING_INDEX };

struct pending {
  uint8_t kind;
  uint8_t code; /* operator_code, or the variable group of an index */
};

struct compiler {
  struct word_list* out;
  uint32_t count, brackets, depth;
  struct pending pending[PENDING_LIMIT];
};

static const struct {
  const char* name;
  uint8_t code;
} FUNCTIONS[] = {/* longer names first */
                 {"ATAN2", OPERATOR_ATAN2}, {"ATAN", OPERATOR_ATAN}, {"ASIN", OPERATOR_ASIN}, {"ACOS", OPERATOR_ACOS},
                 {"SQRT", OPERATOR_SQRT},   {"SIN", OPERATOR_SIN},   {"COS", OPERATOR_COS},   {"TAN", OPERATOR_TAN},
                 {"EXP", OPERATOR_EXP},     {"ABS", OPERATOR_ABS},   {"INT", OPERATOR_INT},   {"LN", OPERATOR_LN}};

static const char BINARY_SPELLING[] = "+-|^*/%&"; /* in the order of operator_code */
const char expression_classes[] = "MPQI";

const char* expression_operator_name(uint32_t code) {
  static const char* const binary[] = {"+", "-", "|", "^", "*", "/", "%", "&", "-"};
  if (code < sizeof binary / sizeof binary[0]) return binary[code];
  for (unsigned i = 0; i < sizeof FUNCTIONS / sizeof FUNCTIONS[0]; i++)
    if (FUNCTIONS[i].code == code) return FUNCTIONS[i].name;
  return 0;
}

error_t word_list_add(struct word_list* list, word48_t word) {
  if (list->count >= list->capacity) return ERR_DATA;
  list->words[list->count++] = word;
  return ERR_NONE;
}

error_t word_list_add_instruction(struct word_list* list, const struct instruction* in) {
  return word_list_add(list, word_encode(in));
}

static error_t emit(struct compiler* c, enum operation operation, uint32_t group, uint32_t number) {
  struct instruction in = {operation, group, number, 0.0};
  return word_list_add_instruction(c->out, &in);
}

static error_t grow(struct compiler* c) { return ++c->depth > EXPRESSION_DEPTH ? ERR_DATA : ERR_NONE; }

/* As a variable keeps it, so that IF(P1=0.1) finds what P1=0.1 has stored. */
error_t word_list_add_constant(struct word_list* list, double exact, bool hexadecimal) {
  const double value = float48_round(exact);
  struct instruction in = {OP_PUSH, hexadecimal, 0, value};
  if (word_holds_exactly(value)) return word_list_add_instruction(list, &in);
  const word48_t form = hexadecimal ? WORD_DOUBLE_HEXADECIMAL : 0;
  error_t error = word_list_add(list, word_double_head(value) | form);
  return error != ERR_NONE ? error : word_list_add(list, word_double_tail(value));
}

static error_t emit_constant(struct compiler* c, double value, bool hexadecimal) {
  error_t error = grow(c);
  return error != ERR_NONE ? error : word_list_add_constant(c->out, value, hexadecimal);
}

static error_t hold(struct compiler* c, enum pending_kind kind, uint32_t code) {
  if (c->count >= PENDING_LIMIT) return ERR_DATA;
  c->pending[c->count++] = (struct pending){(uint8_t)kind, (uint8_t)code};
  if (kind != PENDING_OPERATOR) c->brackets++;
  return ERR_NONE;
}

static bool binds_higher(uint32_t code) { return code >= OPERATOR_MULTIPLY; }

static error_t release_operator(struct compiler* c) {
  uint32_t code = c->pending[--c->count].code;
  if (code < OPERATOR_BINARY_COUNT) c->depth--;
  return emit(c, OP_APPLY, 0, code);
}

/* Emits the pending operators that bind at least as tightly as `code`: equal levels go left to right. */
static error_t release_for(struct compiler* c, uint32_t code) {
  while (c->count > 0 && c->pending[c->count - 1].kind == PENDING_OPERATOR) {
    uint32_t top = c->pending[c->count - 1].code;
    if (!binds_higher(top) && binds_higher(code)) break;
    error_t error = release_operator(c);
    if (error != ERR_NONE) return error;
  }
  return ERR_NONE;
}

static error_t close_bracket(struct compiler* c) {
  error_t error = ERR_NONE;
  while (error == ERR_NONE && c->pending[c->count - 1].kind == PENDING_OPERATOR) error = release_operator(c);
  if (error != ERR_NONE) return error;
  struct pending top = c->pending[--c->count];
  c->brackets--;
  if (top.kind == PENDING_FUNCTION) return emit(c, OP_APPLY, 0, top.code);
  if (top.kind == PENDING_INDEX) return emit(c, OP_PUSH_INDEXED, top.code, 0);
  return ERR_NONE;
}

static error_t open_function(struct compiler* c, struct lexer* lx, bool* found) {
  *found = true;
  for (unsigned i = 0; i < sizeof FUNCTIONS / sizeof FUNCTIONS[0]; i++)
    if (lexer_keyword(lx, FUNCTIONS[i].name))
      return lexer_accept(lx, '(') ? hold(c, PENDING_FUNCTION, FUNCTIONS[i].code) : ERR_DATA;
  *found = false;
  return ERR_NONE;
}

/* A variable with a number is complete; with `(` its index follows as an expression. */
static error_t variable(struct compiler* c, struct lexer* lx, uint32_t group, bool* complete) {
  double number;
  *complete = false;
  if (lexer_accept(lx, '(')) return hold(c, PENDING_INDEX, group);
  if (!lexer_number(lx, &number) || number >= (double)VARIABLE_COUNT || (double)(uint32_t)number != number)
    return ERR_DATA;
  *complete = true;
  error_t error = grow(c);
  return error != ERR_NONE ? error : emit(c, OP_PUSH_VARIABLE, group, (uint32_t)number);
}

/* One step where an operand is due. *complete: an operand ended here, an operator may follow. */
static error_t operand(struct compiler* c, struct lexer* lx, bool* complete) {
  double value;
  bool found;
  const bool hexadecimal = lexer_is_hexadecimal(*lx);
  *complete = false;
  if (lexer_accept(lx, '-')) {
    if (!lexer_number(lx, &value)) return hold(c, PENDING_OPERATOR, OPERATOR_NEGATE);
    value = -value;
    *complete = true;
  } else if (lexer_accept(lx, '+')) {
    return ERR_NONE;
  } else if (lexer_accept(lx, '(')) {
    return hold(c, PENDING_BRACKET, 0);
  } else if (lexer_number(lx, &value)) {
    *complete = true;
  }
  if (*complete)
    return value > LEXER_CONSTANT_LIMIT || value < -LEXER_CONSTANT_LIMIT ? ERR_DATA
                                                                         : emit_constant(c, value, hexadecimal);
  error_t error = open_function(c, lx, &found);
  if (found || error != ERR_NONE) return error;
  for (uint32_t group = 0; group < VARIABLE_CLASSES; group++)
    if (lexer_accept(lx, expression_classes[group])) return variable(c, lx, group, complete);
  return ERR_DATA;
}

static error_t binary_operator(struct compiler* c, struct lexer* lx, bool* found) {
  *found = true;
  for (uint32_t code = 0; code < OPERATOR_BINARY_COUNT; code++) {
    if (!lexer_accept(lx, BINARY_SPELLING[code])) continue;
    error_t error = release_for(c, code);
    return error != ERR_NONE ? error : hold(c, PENDING_OPERATOR, code);
  }
  *found = false;
  return ERR_NONE;
}

error_t expression_compile(struct lexer* lx, bool bracketed, struct word_list* out) {
  struct compiler c;
  c.out = out;
  c.count = c.brackets = c.depth = 0;
  error_t error = ERR_NONE;
  bool complete = false, found = true;
  if (bracketed && lexer_peek(lx) != '(') return ERR_DATA;
  while (error == ERR_NONE) {
    if (!complete) {
      error = operand(&c, lx, &complete);
    } else if (c.brackets > 0 && lexer_accept(lx, ')')) {
      error = close_bracket(&c);
      if (bracketed && c.brackets == 0) break;
    } else {
      error = binary_operator(&c, lx, &found);
      if (!found) break;
      complete = false;
    }
  }
  if (error == ERR_NONE && c.brackets > 0) error = ERR_DATA;
  while (error == ERR_NONE && c.count > 0) error = release_operator(&c);
  return error;
}

error_t expression_evaluate(struct lexer* lx, uint32_t cs, double* value) {
  word48_t words[ON_LINE_WORDS];
  struct word_list list = {words, 0, ON_LINE_WORDS};
  struct evaluator ev = {.depth = 0};
  error_t error = expression_compile(lx, false, &list);
  if (error != ERR_NONE) return error;
  for (uint32_t i = 0; i < list.count; i++) {
    struct instruction in = word_decode(words[i]);
    word48_t head = words[i], raw = 0;
    if (in.operation == OP_PUSH_DOUBLE) raw = words[++i];
    if (!evaluator_execute(&ev, &in, head, raw, cs)) return ERR_DATA;
  }
  return evaluator_pop(&ev, value) ? ERR_NONE : ERR_DATA;
}
