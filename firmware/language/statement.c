/* Compiler of program statements: finds the head in the statement table and compiles assignments; what follows the
 * head is compiled by statement_argument.c. */
#include "firmware/language/statement.h"

#include "firmware/base/dimensions.h"
#include "firmware/language/statement_argument.h"

/* What a letter means, A to Z: one more than enum axis or enum variable_class, 0 nothing. Looked up for every value of
 * a line. The axes are the first rows of the table. */
static const uint8_t AXIS_OF[26] = {1, 2, 3, ['U' - 'A'] = 4, 5, 6, 7, 8, 9};
static const uint8_t CLASS_OF[26] = {['M' - 'A'] = 1, ['P' - 'A'] = 2, ['Q' - 'A'] = 3, ['I' - 'A'] = 4};

enum { WHERE_KINDS = WHERE_PROG | WHERE_ROTARY | WHERE_PLC | WHERE_KINEMATIC };

static bool find_letter(struct lexer* lx, const uint8_t meaning[26], uint32_t* index) {
  uint32_t letter = (uint32_t)(uint8_t)lexer_peek(lx) - 'A';
  if (letter >= 26 || meaning[letter] == 0) return false;
  lx->at++;
  *index = meaning[letter] - 1u;
  return true;
}

static bool skip_brackets(struct lexer* lx) {
  uint32_t depth = 0;
  do {
    char c = lexer_peek(lx);
    if (c == '\0') return false;
    if (c == '(') depth++;
    if (c == ')') depth--;
    lx->at++;
  } while (depth > 0);
  return true;
}

/* An axis letter with its value. Looked for first: no keyword goes on with a number, and these are most of all
 * statements. */
static bool axis_starts(struct lexer* lx, uint32_t* axis) {
  (void)lexer_peek(lx);
  struct lexer start = *lx;
  if (find_letter(lx, AXIS_OF, axis)) {
    char c = lexer_peek(lx);
    if ((c >= '0' && c <= '9') || c == '.' || c == '$' || c == '-' || c == '+' || c == '(') return true;
  }
  *lx = start;
  return false;
}

/* `=`, for M also `==`, `&=`, `|=`, `^=` in a motion program: enum synchronous, or SYNCHRONOUS_COUNT. */
static bool accept_equals(struct lexer* lx, uint32_t group, uint32_t* synchronous) {
  static const char letters[] = "&|^"; /* behind SYNCHRONOUS_SET */
  *synchronous = SYNCHRONOUS_COUNT;
  for (uint32_t i = 0; group == VARIABLE_M && letters[i] != '\0'; i++)
    if (lexer_accept(lx, letters[i])) *synchronous = i + SYNCHRONOUS_AND;
  if (!lexer_accept(lx, '=')) return false;
  if (group == VARIABLE_M && *synchronous == SYNCHRONOUS_COUNT && lexer_accept(lx, '=')) *synchronous = SYNCHRONOUS_SET;
  return true;
}

/* `P5=`, `P(..)=`: an assignment. A query such as `P5` is an on-line command whatever is open. */
static bool assignment_starts(struct lexer lx) {
  uint32_t group, synchronous;
  double number;
  if (!find_letter(&lx, CLASS_OF, &group)) return false;
  bool indexed = lexer_peek(&lx) == '(' ? skip_brackets(&lx) : lexer_number(&lx, &number);
  return indexed && accept_equals(&lx, group, &synchronous);
}

/* Letters by which a name of the table is spelled, with blanks where it has one; 0: it is not next. */
static const char* match(struct lexer lx, const char* name) {
  (void)lexer_peek(&lx);
  for (; *name != '\0'; name++) {
    if (*name == ' ' || *name == '_')
      (void)lexer_peek(&lx);
    else if (*lx.at++ != *name)
      return 0;
  }
  return lx.at;
}

/* `M1->` and `M1..5` are on-line commands whatever is open. */
static bool is_code(struct lexer lx) {
  double number;
  if (lexer_peek(&lx) == '(') return true;
  (void)lexer_number(&lx, &number);
  return !lexer_keyword(&lx, "->") && !lexer_keyword(&lx, "..") && lexer_peek(&lx) != ',';
}

/* What follows decides between a statement and something else that begins with the same letters. */
static bool argument_starts(struct lexer lx, const struct statement_row* row, uint32_t where) {
  const char c = lexer_peek(&lx);
  switch (row->argument) {
    case ARGUMENT_NONE:
    case ARGUMENT_AXES:
    case ARGUMENT_FRAX:
      return true;
    case ARGUMENT_CONDITION:
    case ARGUMENT_LETTERS:
      return c == '(';
    case ARGUMENT_MOTORS:
    case ARGUMENT_PLCS:
      return c >= '0' && c <= '9';
    case ARGUMENT_ADDRESS:
      return c == '#' || c == '&';
    case ARGUMENT_TEXT:
      return c == '"' || c == '^';
    case ARGUMENT_DISPLAY:
      return c == '"' || (c >= '0' && c <= '9');
    case ARGUMENT_CODE:
      return (where & WHERE_MOVES) != 0 && lexer_value_starts(lx) && is_code(lx);
    default:
      return lexer_value_starts(lx);
  }
}

/* The longest name that fits. Searches for every statement: the first letter decides before anything is called. */
static bool find_row(struct lexer* lx, uint32_t where, uint32_t* index) {
  const char first = lexer_peek(lx);
  const char* end = 0;
  for (uint32_t i = AXIS_COUNT; i < statement_row_count; i++) {
    const struct statement_row* row = &statement_rows[i];
    if (row->name[0] != first) continue;
    if ((row->where & (WHERE_BEGUN | WHERE_CALLED) & ~where) != 0) continue;
    const char* found = match(*lx, row->name);
    if (found == 0 && row->brief != 0) found = match(*lx, row->brief);
    if (found == 0 || (end != 0 && found <= end)) continue;
    const struct lexer behind = {found};
    if (!argument_starts(behind, row, where)) continue;
    end = found;
    *index = i;
  }
  if (end == 0) return false;
  lx->at = end;
  return true;
}

struct statement statement_find(struct lexer* lx, uint32_t where) {
  struct statement found = {STATEMENT_ROW, 0};
  const struct lexer start = *lx;
  if (axis_starts(lx, &found.index)) {
    if (found.index != AXIS_B || (where & (WHERE_PLC | WHERE_KINEMATIC)) == 0) return found;
    *lx = start; /* no moves there: B{n} is the command that points to a program */
    found.kind = STATEMENT_NONE;
    return found;
  }
  if (assignment_starts(*lx)) {
    found.kind = STATEMENT_ASSIGNMENT;
    (void)find_letter(lx, CLASS_OF, &found.index);
  } else if (!find_row(lx, where, &found.index)) {
    found.kind = STATEMENT_NONE;
  }
  return found;
}

bool statement_starts(struct lexer lx) { return statement_find(&lx, 0).kind != STATEMENT_NONE; }

/* A constant of 24 bits stands in the word of its variable, as in a binary rotary buffer (host-bus:7.7). */
static error_t add_short_assignment(struct word_list* out, uint32_t group, uint32_t synchronous, uint32_t number,
                                    double value) {
  struct instruction in = {OP_ASSIGN, group, number & 0x3FFu, value};
  if (synchronous != SYNCHRONOUS_COUNT) {
    in.operation = OP_STATEMENT;
    in.number |= WORD_KEY(4, synchronous + 1u, 0);
  }
  if (number > 0x3FFu) {
    const struct instruction prefix = {OP_PREFIX, 0, number >> 10, 0.0};
    const error_t error = word_list_add_instruction(out, &prefix);
    if (error != ERR_NONE) return error;
  }
  return word_list_add_instruction(out, &in);
}

static error_t compile_assignment(struct lexer* lx, uint32_t group, uint32_t where, struct word_list* out) {
  struct instruction in = {OP_ASSIGN_POP, group, 0, 0.0};
  double number;
  uint32_t synchronous;
  bool indexed = lexer_peek(lx) == '(';
  error_t error = ERR_NONE;
  if (indexed) {
    in.operation = OP_ASSIGN_INDEXED;
    error = expression_compile(lx, true, out);
  } else {
    if (!lexer_number(lx, &number) || number >= (double)VARIABLE_COUNT || (double)(uint32_t)number != number)
      return ERR_DATA;
    in.number = (uint32_t)number;
  }
  if (error != ERR_NONE || !accept_equals(lx, group, &synchronous)) return ERR_DATA;
  struct word_list before = *out;
  error = expression_compile(lx, false, out);
  if (error != ERR_NONE) return error;
  if (synchronous != SYNCHRONOUS_COUNT && (where & WHERE_MOVES) == 0) return ERR_DATA;
  const struct instruction constant = word_decode(out->words[before.count]);
  const bool single = out->count == before.count + 1 && constant.operation == OP_PUSH && constant.group == 0;
  if (single && !indexed && word_holds_short(constant.value)) {
    *out = before;
    return add_short_assignment(out, group, synchronous, in.number, constant.value);
  }
  if (synchronous != SYNCHRONOUS_COUNT) {
    in.operation = indexed ? OP_SYNCHRONOUS_INDEXED : OP_SYNCHRONOUS;
    in.group = synchronous;
  }
  return word_list_add_instruction(out, &in);
}

error_t statement_compile(struct lexer* lx, struct statement head, uint32_t where, struct word_list* out) {
  if (head.kind == STATEMENT_ROW && head.index < AXIS_COUNT && (where & WHERE_MOVES) != 0)
    return statement_axis_compile(lx, head.index, out);
  if (head.kind == STATEMENT_ASSIGNMENT) return compile_assignment(lx, head.index, where, out);
  if (head.kind == STATEMENT_NONE || (statement_rows[head.index].where & where & WHERE_KINDS) == 0) return ERR_DATA;
  return statement_argument_compile(lx, &statement_rows[head.index], out);
}
