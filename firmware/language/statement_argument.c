/* Compiler of arguments. An axis, a rate and a plain assignment have operations of their own; every other statement is
 * OP_STATEMENT with its code, so a new row of the table needs nothing here. */
#include "firmware/language/statement_argument.h"

#include "firmware/base/dimensions.h"
#include "firmware/base/float48.h"
#include "firmware/language/statement_list.h"

static bool is_code(const struct statement_row* row, uint32_t code1, uint32_t code2) {
  return row->code >> 10 == (code1 << 3 | code2);
}

static uint32_t code_number(const struct statement_row* row) { return row->code & 0x3FFu; }

static bool has_wide_form(const struct statement_row* row) {
  return is_code(row, 1, 0) || (is_code(row, 3, 0) && code_number(row) < RATE_COUNT);
}

static bool is_in_range(const struct statement_row* row, double value) {
  switch (row->argument) {
    case ARGUMENT_RATE:
      return value >= 0.0;
    case ARGUMENT_TIME:
      return value >= 0.0 && value <= 8388607.0;
    case ARGUMENT_LABEL:
      return value >= 0.0 && value <= (double)LABEL_LIMIT && (double)(uint32_t)value == value;
    default:
      return true;
  }
}

/* An axis or rate holds its constant in 33 bits, another statement in 24; else the value is pushed before it. */
static error_t add_constant(const struct statement_row* row, double value, bool hexadecimal, struct word_list* out) {
  struct instruction in = {OP_STATEMENT, hexadecimal, row->code, float48_round(value)};
  if (has_wide_form(row)) {
    in = (struct instruction){is_code(row, 1, 0) ? OP_AXIS : OP_RATE, hexadecimal, code_number(row), value};
  } else if (hexadecimal || !word_holds_short(in.value)) {
    const error_t error = word_list_add_constant(out, value, hexadecimal);
    if (error != ERR_NONE) return error;
    in.operation = OP_STATEMENT_POP;
  }
  return word_list_add_instruction(out, &in);
}

static error_t value(struct lexer* lx, const struct statement_row* row, struct word_list* out) {
  if (lexer_peek(lx) != '(') {
    double constant;
    const bool hexadecimal = lexer_is_hexadecimal(*lx);
    error_t error = lexer_constant(lx, &constant);
    if (error == ERR_NONE && !is_in_range(row, constant)) error = ERR_DATA;
    if (row->argument == ARGUMENT_LABEL && hexadecimal) error = ERR_DATA; /* it would be a pushed value */
    return error != ERR_NONE ? error : add_constant(row, constant, hexadecimal, out);
  }
  struct instruction in = {OP_STATEMENT_POP, 0, row->code, 0.0};
  if (row->argument == ARGUMENT_LABEL) return ERR_DATA;
  if (has_wide_form(row)) {
    in.operation = is_code(row, 1, 0) ? OP_AXIS_POP : OP_RATE_POP;
    in.number = code_number(row);
  }
  const error_t error = expression_compile(lx, true, out);
  return error != ERR_NONE ? error : word_list_add_instruction(out, &in);
}

/* X1000^0.5: distance behind a trigger. X1000:500: velocity at the end of a PVT move. */
error_t statement_axis_compile(struct lexer* lx, uint32_t axis, struct word_list* out) {
  struct statement_row second = {0, 0, 0, ARGUMENT_VALUE, 0};
  const error_t error = value(lx, &statement_rows[axis], out);
  if (error != ERR_NONE) return error;
  const char next = lexer_peek(lx);
  if (next != '^' && next != ':') return ERR_NONE;
  lx->at++;
  second.code = WORD_KEY(1, next == '^' ? 2 : 3, axis);
  return value(lx, &second, out);
}

static error_t plain(const struct statement_row* row, struct word_list* out) {
  struct instruction in = {OP_STATEMENT, 0, row->code, 0.0};
  if (is_code(row, 2, 0) && code_number(row) <= MODE_RAPID) {
    in.operation = OP_MODE;
    in.number = code_number(row);
  } else if (is_code(row, 2, 3)) { /* NOFRAX */
    in.operation = OP_FRAX;
    in.number = 0;
  }
  return word_list_add_instruction(out, &in);
}

static error_t axes(struct lexer* lx, const struct statement_row* row, struct word_list* out) {
  struct instruction in = {OP_FRAX, 0, 0, 0.0};
  error_t error;
  if (row->argument == ARGUMENT_FRAX) {
    error = statement_frax_list(lx, &in.number);
    if (in.number & AXIS_VECTOR) error = ERR_DATA;
  } else {
    in.operation = is_code(row, 2, 1) ? OP_ABS : OP_INC;
    error = statement_axis_list(lx, AXIS_ALL, &in.number);
  }
  return error != ERR_NONE ? error : word_list_add_instruction(out, &in);
}

static error_t comparator(struct lexer* lx, uint32_t* code) {
  static const char spelling[] = "=><~";
  const uint32_t negated = lexer_accept(lx, '!');
  for (uint32_t i = 0; spelling[i] != '\0'; i++) {
    if (!lexer_accept(lx, spelling[i])) continue;
    *code = 2u * i + negated;
    return ERR_NONE;
  }
  return ERR_DATA;
}

static error_t condition(struct lexer* lx, const struct statement_row* row, struct word_list* out) {
  struct instruction in = {.operation = OP_CONDITION, .group = code_number(row)};
  bool more = true;
  if (!lexer_accept(lx, '(')) return ERR_DATA;
  while (more) {
    error_t error = expression_compile(lx, false, out);
    if (error == ERR_NONE) error = comparator(lx, &in.number);
    if (error == ERR_NONE) error = expression_compile(lx, false, out);
    if (error != ERR_NONE) return error;
    const bool and_follows = lexer_keyword(lx, "AND");
    more = and_follows || lexer_keyword(lx, "OR");
    if (more) in.number |= CONDITION_MORE;
    error = word_list_add_instruction(out, &in);
    if (error != ERR_NONE) return error;
    in.group = and_follows ? CONDITION_INNER_AND : CONDITION_INNER_OR;
  }
  return lexer_accept(lx, ')') ? ERR_NONE : ERR_DATA;
}

static error_t letters(struct lexer* lx, uint32_t* mask) {
  if (*lx->at != '(') return ERR_DATA;
  lx->at++;
  *mask = 0;
  do {
    const char c = lexer_peek(lx);
    if (c < 'A' || c > 'Z' || c == 'N' || c == 'O') return ERR_DATA;
    *mask |= 1u << (c - 'A');
    lx->at++;
  } while (lexer_accept(lx, ','));
  return lexer_accept(lx, ')') ? ERR_NONE : ERR_DATA;
}

static error_t integer(struct lexer* lx, int32_t first, int32_t last, uint32_t* number) {
  int32_t n;
  if (lexer_integer(lx, &n) != ERR_NONE || n < first || n > last) return ERR_DATA;
  *number = (uint32_t)n;
  return ERR_NONE;
}

/* Numbers alone lie in a byte each, as in the programs that older images have saved. */
enum { ADDRESS_BYTE = 0xFF, ADDRESS_BYTES = 8, ADDRESS_PART = 0x3FFF, ADDRESS_PARTS = 14 };
#define ADDRESS_WIDE (1u << 31)

uint32_t statement_address(uint32_t motor, uint32_t cs) {
  return motor < ADDRESS_VARIABLE && cs < ADDRESS_VARIABLE ? motor | cs << ADDRESS_BYTES
                                                           : motor | cs << ADDRESS_PARTS | ADDRESS_WIDE;
}

uint32_t statement_address_motor(uint32_t number) {
  return number & ((number & ADDRESS_WIDE) != 0 ? ADDRESS_PART : ADDRESS_BYTE);
}

uint32_t statement_address_cs(uint32_t number) {
  return (number & ADDRESS_WIDE) != 0 ? number >> ADDRESS_PARTS & ADDRESS_PART : number >> ADDRESS_BYTES & ADDRESS_BYTE;
}

/* One part of ADDRESS: its number, or the P-variable that holds it when the statement is executed. */
static error_t address_part(struct lexer* lx, int32_t last, uint32_t* part) {
  if (!lexer_accept(lx, 'P')) return integer(lx, 1, last, part);
  const error_t error = integer(lx, 0, VARIABLE_COUNT - 1, part);
  *part |= ADDRESS_VARIABLE;
  return error;
}

static error_t address(struct lexer* lx, uint32_t* number) {
  uint32_t motor = 0, cs = 0;
  error_t error = ERR_NONE;
  if (lexer_accept(lx, '#')) error = address_part(lx, MOTORS, &motor);
  if (error == ERR_NONE && lexer_accept(lx, '&')) error = address_part(lx, COORDINATE_SYSTEMS, &cs);
  *number = statement_address(motor, cs);
  return *number == 0 ? ERR_DATA : error;
}

static error_t list(struct lexer* lx, const struct statement_row* row, struct word_list* out) {
  struct instruction in = {OP_LIST, row->code, 0, 0.0};
  error_t error;
  switch (row->argument) {
    case ARGUMENT_LETTERS:
      error = letters(lx, &in.number);
      break;
    case ARGUMENT_MOTORS:
      error = statement_number_list(lx, 1, MOTORS, &in.number);
      break;
    case ARGUMENT_PLCS:
      error = statement_number_list(lx, 0, 31, &in.number);
      break;
    default:
      error = address(lx, &in.number);
      break;
  }
  return error != ERR_NONE ? error : word_list_add_instruction(out, &in);
}

/* The characters are taken as they stand: no blank, `;` or lower case means anything in them. */
static error_t add_characters(const char* at, uint32_t count, struct word_list* out) {
  error_t error = ERR_NONE;
  for (uint32_t first = 0; first < count && error == ERR_NONE; first += WORD_TEXT_CHARACTERS) {
    word48_t word = 0;
    for (uint32_t i = 0; i < WORD_TEXT_CHARACTERS && first + i < count; i++)
      word |= (word48_t)(uint8_t)at[first + i] << (8u * i);
    error = word_list_add(out, word);
  }
  return error;
}

static error_t text(struct lexer* lx, const struct statement_row* row, uint32_t column, struct word_list* out) {
  struct instruction in = {OP_TEXT, row->code, column << TEXT_COLUMN_BIT, 0.0};
  if (!lexer_accept(lx, '"')) return ERR_DATA;
  const char* begin = lx->at;
  while (*lx->at != '"') {
    if (*lx->at == '\0') return ERR_DATA;
    lx->at++;
  }
  const uint32_t count = (uint32_t)(lx->at - begin);
  lx->at++;
  if (count > TEXT_LENGTH) return ERR_DATA;
  in.number |= count;
  const error_t error = word_list_add_instruction(out, &in);
  return error != ERR_NONE ? error : add_characters(begin, count, out);
}

static error_t text_or_control(struct lexer* lx, const struct statement_row* row, struct word_list* out) {
  if (!lexer_accept(lx, '^')) return text(lx, row, 0, out);
  const char c = lexer_peek(lx);
  if (c < '@' || c > '_') return ERR_DATA;
  lx->at++;
  const struct instruction in = {OP_TEXT, row->code, (uint32_t)c << TEXT_CONTROL_BIT, 0.0};
  return word_list_add_instruction(out, &in);
}

/* DISP 5"text", DISP 5,8.3,P100. */
static error_t display(struct lexer* lx, const struct statement_row* row, struct word_list* out) {
  uint32_t column = 0, width, decimals = 0;
  if (lexer_peek(lx) == '"') return text(lx, row, 0, out);
  error_t error = integer(lx, 0, DISPLAY_COLUMNS - 1, &column);
  if (error != ERR_NONE) return error;
  if (!lexer_accept(lx, ',')) return text(lx, row, column + 1u, out);
  (void)lexer_peek(lx);
  const char* at = lx->at;
  for (width = 0; *at >= '0' && *at <= '9' && width < 100u; at++) width = width * 10u + (uint32_t)(*at - '0');
  if (*at == '.') {
    decimals = (uint32_t)(uint8_t)at[1] - '0';
    at += at[1] == '\0' ? 1 : 2;
  }
  lx->at = at;
  if (width < 1u || width > 16u || decimals > 9u || !lexer_accept(lx, ',')) return ERR_DATA;
  error = expression_compile(lx, false, out);
  const struct instruction in = {OP_LIST, DISPLAY_VALUE,
                                 column | width << DISPLAY_WIDTH_BIT | decimals << DISPLAY_DECIMALS_BIT, 0.0};
  return error != ERR_NONE ? error : word_list_add_instruction(out, &in);
}

/* LOCK5,P100. */
error_t statement_lock(struct lexer* lx, uint32_t* number) {
  uint32_t lock, variable;
  error_t error = integer(lx, 0, LOCK_COUNT - 1, &lock);
  if (error == ERR_NONE && (!lexer_accept(lx, ',') || !lexer_accept(lx, 'P'))) error = ERR_DATA;
  if (error == ERR_NONE) error = integer(lx, 0, VARIABLE_COUNT - 1, &variable);
  if (error == ERR_NONE) *number = lock | variable << LOCK_VARIABLE_BIT;
  return error;
}

static error_t lock(struct lexer* lx, const struct statement_row* row, struct word_list* out) {
  struct instruction in = {OP_LIST, LOCK_TELLING, 0, 0.0};
  struct lexer after = *lx;
  double number;
  if (lexer_constant(&after, &number) != ERR_NONE || !lexer_accept(&after, ',')) return value(lx, row, out);
  const error_t error = statement_lock(lx, &in.number);
  return error != ERR_NONE ? error : word_list_add_instruction(out, &in);
}

error_t statement_argument_compile(struct lexer* lx, const struct statement_row* row, struct word_list* out) {
  switch (row->argument) {
    case ARGUMENT_NONE:
      return plain(row, out);
    case ARGUMENT_AXES:
    case ARGUMENT_FRAX:
      return axes(lx, row, out);
    case ARGUMENT_CONDITION:
      return condition(lx, row, out);
    case ARGUMENT_LETTERS:
    case ARGUMENT_MOTORS:
    case ARGUMENT_PLCS:
    case ARGUMENT_ADDRESS:
      return list(lx, row, out);
    case ARGUMENT_TEXT:
      return text_or_control(lx, row, out);
    case ARGUMENT_DISPLAY:
      return display(lx, row, out);
    case ARGUMENT_LOCK:
      return lock(lx, row, out);
    default:
      return value(lx, row, out);
  }
}
