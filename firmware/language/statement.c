/* Compiler of program statements. Branches, loops, calls and arcs are recognised as statements, so that they are
 * answered with ERR005 when no buffer is open, and refused with ERR003: a ring of words cannot be jumped about in. */
#include "firmware/language/statement.h"

/* What a letter means, A to Z: one more than enum axis or enum variable_class, 0 nothing. Looked up for every value of
 * a line. */
static const uint8_t AXIS_OF[26] = {1, 2, 3, ['U' - 'A'] = 4, 5, 6, 7, 8, 9};
static const uint8_t CLASS_OF[26] = {['M' - 'A'] = 1, ['P' - 'A'] = 2, ['Q' - 'A'] = 3, ['I' - 'A'] = 4};

static const struct {
  const char* name;
  uint8_t operation;
  uint8_t number;
} KEYWORDS[] = {/* longer names first */
                {"DWELL", OP_RATE, RATE_DWELL},
                {"DWE", OP_RATE, RATE_DWELL},
                {"DELAY", OP_RATE, RATE_DELAY},
                {"DLY", OP_RATE, RATE_DELAY},
                {"TM", OP_RATE, RATE_TM},
                {"TA", OP_RATE, RATE_TA},
                {"TS", OP_RATE, RATE_TS},
                {"LINEAR", OP_MODE, MODE_LINEAR},
                {"LIN", OP_MODE, MODE_LINEAR},
                {"RAPID", OP_MODE, MODE_RAPID},
                {"RPD", OP_MODE, MODE_RAPID},
                {"ABS", OP_ABS, 0},
                {"INC", OP_INC, 0},
                {"NOFRAX", OP_FRAX, 1},
                {"FRAX", OP_FRAX, 0}};

/* Statements of fixed programs. */
static const char* const OTHERS[] = {"ADIS", "AROT",   "BLOCKST", "BSTART",  "BSTOP", "CALL",  "CC0",   "CC1",
                                     "CC2",  "CMD",    "COMMAND", "DISP",    "CC3",   "CCR",   "CIR",   "ELSE",
                                     "ENDI", "ENDW",   "GOS",     "GOTO",    "IDIS",  "IF(",   "IROT",  "MOVETIME",
                                     "MVTM", "NORMAL", "NRM",     "PRELUDE", "PSET",  "PVT",   "READ(", "RET",
                                     "SEND", "SPLINE", "STOP",    "TINIT",   "TSEL",  "WHILE", "WAIT"};

enum { KEYWORD_COUNT = sizeof KEYWORDS / sizeof KEYWORDS[0], OTHER_COUNT = sizeof OTHERS / sizeof OTHERS[0] };

static bool number_starts(struct lexer* lx) {
  char c = lexer_peek(lx);
  return (c >= '0' && c <= '9') || c == '.' || c == '$' || c == '-' || c == '+' || c == '(';
}

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
  if (find_letter(lx, AXIS_OF, axis) && number_starts(lx)) return true;
  *lx = start;
  return false;
}

/* `P5=`, `P(..)=`: an assignment. A query such as `P5` is an on-line command whatever is open. */
static bool assignment_starts(struct lexer lx) {
  uint32_t group;
  double number;
  if (!find_letter(&lx, CLASS_OF, &group)) return false;
  bool indexed = lexer_peek(&lx) == '(' ? skip_brackets(&lx) : lexer_number(&lx, &number);
  return indexed && lexer_peek(&lx) == '=';
}

static bool feed_starts(struct lexer* lx) {
  struct lexer start = *lx;
  if (lexer_accept(lx, 'F') && number_starts(lx)) return true;
  *lx = start;
  return false;
}

/* Searches for every statement: the first letter decides before anything is called. KEYWORD_COUNT: none. */
static uint32_t accept_keyword(struct lexer* lx) {
  char first = lexer_peek(lx);
  uint32_t i = 0;
  while (i < KEYWORD_COUNT && !(KEYWORDS[i].name[0] == first && lexer_keyword(lx, KEYWORDS[i].name))) i++;
  return i;
}

static bool accept_other(struct lexer* lx) {
  char first = lexer_peek(lx);
  for (uint32_t i = 0; i < OTHER_COUNT; i++)
    if (OTHERS[i][0] == first && lexer_keyword(lx, OTHERS[i])) return true;
  return false;
}

/* The head of a statement is looked for once: `lx` is left behind its letter or keyword. */
struct statement statement_find(struct lexer* lx) {
  const struct lexer start = *lx;
  struct statement found = {STATEMENT_NONE, 0};
  if (axis_starts(lx, &found.index)) {
    found.kind = STATEMENT_AXIS;
  } else if (feed_starts(lx)) {
    found.kind = STATEMENT_FEED;
  } else if (assignment_starts(*lx)) {
    found.kind = STATEMENT_ASSIGNMENT;
    (void)find_letter(lx, CLASS_OF, &found.index);
  } else if ((found.index = accept_keyword(lx)) < KEYWORD_COUNT) {
    if (KEYWORDS[found.index].operation != OP_RATE || number_starts(lx)) found.kind = STATEMENT_KEYWORD;
  } else if (accept_other(lx) ||
             ((lexer_accept(lx, 'N') || lexer_accept(lx, 'O') || lexer_accept(lx, 'G')) && number_starts(lx))) {
    found.kind = STATEMENT_OTHER;
  }
  if (found.kind == STATEMENT_NONE) *lx = start;
  return found;
}

bool statement_starts(struct lexer lx) { return statement_find(&lx).kind != STATEMENT_NONE; }

error_t statement_axis_list(struct lexer* lx, uint32_t bare, uint32_t* mask) {
  uint32_t axis;
  *mask = bare;
  if (!lexer_accept(lx, '(')) return ERR_NONE;
  *mask = 0;
  do {
    if (lexer_accept(lx, 'R'))
      *mask |= AXIS_VECTOR;
    else if (find_letter(lx, AXIS_OF, &axis))
      *mask |= 1u << axis;
    else
      return ERR_DATA;
  } while (lexer_accept(lx, ','));
  return lexer_accept(lx, ')') ? ERR_NONE : ERR_DATA;
}

/* No space may stand before the bracket of FRAX(. */
error_t statement_frax_list(struct lexer* lx, uint32_t* mask) {
  if (*lx->at == ' ' && lexer_peek(lx) == '(') return ERR_DATA;
  return statement_axis_list(lx, AXIS_XYZ, mask);
}

/* A value behind an axis letter or a keyword: a constant in the same word, or an expression in brackets before it. */
static error_t compile_value(struct lexer* lx, enum operation constant, enum operation popped, uint32_t number,
                             struct word_list* out) {
  struct instruction in = {constant, 0, number, 0.0};
  error_t error;
  if (lexer_peek(lx) == '(') {
    in.operation = popped;
    error = expression_compile(lx, true, out);
  } else {
    error = lexer_constant(lx, &in.value);
    if (error == ERR_NONE && constant == OP_RATE && (in.value < 0.0 || (number == RATE_F && in.value == 0.0)))
      error = ERR_DATA;
    if (error == ERR_NONE && number == RATE_TM && constant == OP_RATE && in.value > 8388607.0) error = ERR_DATA;
  }
  return error != ERR_NONE ? error : word_list_add_instruction(out, &in);
}

static error_t compile_assignment(struct lexer* lx, uint32_t group, struct word_list* out) {
  struct instruction in = {OP_ASSIGN_POP, group, 0, 0.0};
  double number;
  error_t error = ERR_NONE;
  if (lexer_peek(lx) == '(') {
    in.operation = OP_ASSIGN_INDEXED;
    error = expression_compile(lx, true, out);
  } else {
    if (!lexer_number(lx, &number) || number > 8191.0 || (double)(uint32_t)number != number) return ERR_DATA;
    in.number = (uint32_t)number;
  }
  if (error != ERR_NONE || !lexer_accept(lx, '=')) return ERR_DATA;
  struct word_list before = *out;
  error = expression_compile(lx, false, out);
  if (error != ERR_NONE) return error;
  struct instruction constant = word_decode(out->words[before.count]);
  bool single = out->count == before.count + 1 && constant.operation == OP_PUSH;
  if (single && in.operation == OP_ASSIGN_POP && in.number < 1024 &&
      word_holds_short(constant.value)) { /* one word holds it all */
    *out = before;
    in.operation = OP_ASSIGN;
    in.value = constant.value;
  }
  return word_list_add_instruction(out, &in);
}

static error_t compile_keyword(struct lexer* lx, uint32_t index, struct word_list* out) {
  struct instruction in = {(enum operation)KEYWORDS[index].operation, 0, KEYWORDS[index].number, 0.0};
  error_t error = ERR_NONE;
  switch (in.operation) {
    case OP_RATE:
      return compile_value(lx, OP_RATE, OP_RATE_POP, in.number, out);
    case OP_ABS:
    case OP_INC:
      error = statement_axis_list(lx, AXIS_ALL, &in.number);
      break;
    case OP_FRAX:
      if (in.number == 1)
        in.number = 0; /* NOFRAX */
      else
        error = statement_frax_list(lx, &in.number);
      if (in.number & AXIS_VECTOR) error = ERR_DATA;
      break;
    default:
      break;
  }
  return error != ERR_NONE ? error : word_list_add_instruction(out, &in);
}

error_t statement_compile(struct lexer* lx, struct statement head, struct word_list* out) {
  switch (head.kind) {
    case STATEMENT_AXIS:
      return compile_value(lx, OP_AXIS, OP_AXIS_POP, head.index, out);
    case STATEMENT_FEED:
      return compile_value(lx, OP_RATE, OP_RATE_POP, RATE_F, out);
    case STATEMENT_ASSIGNMENT:
      return compile_assignment(lx, head.index, out);
    case STATEMENT_KEYWORD:
      return compile_keyword(lx, head.index, out);
    default:
      return ERR_DATA;
  }
}
