/* The lister goes by the statement table, as the compiler does. Values collect until the statement comes that pops
 * them. Statements follow each other without a blank but where the second would be read as part of the first: behind a
 * keyword without argument and behind a hexadecimal constant. */
#include "firmware/language/lister.h"

#include "firmware/language/constant_text.h"
#include "firmware/language/expression.h"
#include "firmware/language/expression_text.h"
#include "firmware/language/lexer.h"
#include "firmware/language/statement_argument.h"

static struct {
  void (*put)(char c);
  bool long_form, blank_due, in_hexadecimal;
  uint32_t prefix;
  struct expression_text x;
} list; /* of the line being listed: the lister is not entered twice */

static void put(char c) {
  const bool is_digit = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'F');
  list.in_hexadecimal = c == '$' || (list.in_hexadecimal && is_digit);
  list.put(c);
}

static void text(const char* t) {
  while (*t != '\0') put(*t++);
}

static void keyword(const struct statement_row* row) {
  const char* name = list.long_form || row->brief == 0 ? row->name : row->brief;
  for (; *name != '\0'; name++)
    if (*name != '_') put(*name);
}

static void statement_name(uint32_t code) {
  const struct statement_row* row = statement_row_of(code);
  if (row != 0)
    keyword(row);
  else
    put('?');
}

static void constant(const struct instruction* in, double value) { constant_text(in, value, put); }

static void expression(uint32_t root) { expression_text_put(&list.x, root, put); }

static void bracketed(uint32_t root) {
  put('(');
  expression_text_put(&list.x, root, put);
  put(')');
}

/* A popped value. Of a statement without wide form it was a constant when it could not be held in the word. */
static void popped(const struct instruction* in) {
  uint32_t root;
  double value;
  if (!expression_text_last(&list.x, &root)) {
    put('?');
    return;
  }
  const struct instruction last = expression_text_operation(&list.x, root, &value);
  const bool is_constant = last.operation == OP_PUSH || last.operation == OP_PUSH_DOUBLE;
  if (in->operation == OP_STATEMENT_POP && is_constant && value >= 0.0 && (last.group == 1 || !word_holds_short(value)))
    constant(&last, value);
  else
    bracketed(root);
}

static void value(const struct instruction* in) {
  if (in->operation == OP_AXIS || in->operation == OP_RATE || in->operation == OP_STATEMENT)
    constant(in, in->value);
  else
    popped(in);
}

/* Statements that OP_STATEMENT has: a name, nothing or a value behind it. */
static void plain(const struct instruction* in) {
  const uint32_t code1_2 = in->number >> 10, n = in->number & 0x3FFu;
  if (code1_2 == (1u << 3 | 2u) || code1_2 == (1u << 3 | 3u)) { /* second value of an axis */
    put(code1_2 == (1u << 3 | 2u) ? '^' : ':');
    value(in);
    return;
  }
  if (in->number >> 13 == 4u) { /* synchronous M of the binary format */
    static const char* const equals[] = {"==", "&=", "|=", "^="};
    put('M');
    integer_text(n + list.prefix, put);
    text(equals[((in->number >> 10) - 1u) & 3u]);
    value(in);
    return;
  }
  const struct statement_row* row = statement_row_of(in->number);
  statement_name(in->number);
  if (row != 0 && row->argument != ARGUMENT_NONE)
    value(in);
  else
    list.blank_due = true;
}

static void assignment(char letter, const struct instruction* in, bool indexed, const char* equals) {
  uint32_t root, index;
  const bool has_value = expression_text_last(&list.x, &root);
  put(letter);
  if (!indexed)
    integer_text(in->number + list.prefix, put);
  else if (has_value && expression_text_before(&list.x, root, &index))
    bracketed(index);
  else
    text("(?)");
  text(equals);
  if (has_value)
    expression(root);
  else
    put('?');
}

static void axis_list(uint32_t code, uint32_t mask, uint32_t bare) {
  static const char letters[] = "ABCUVWXYZR"; /* bits 0 and up */
  char before = '(';
  statement_name(code);
  list.blank_due = mask == bare;
  if (mask == bare) return;
  for (uint32_t i = 0; letters[i] != '\0'; i++) {
    if ((mask >> i & 1u) == 0) continue;
    put(before);
    put(letters[i]);
    before = ',';
  }
  if (before == ',') put(')');
}

static void condition(const struct instruction* in) {
  static const char* const comparators[] = {"=", "!=", ">", "!>", "<", "!<", "~", "!~"};
  uint32_t right, left;
  if (in->group == CONDITION_INNER_AND || in->group == CONDITION_INNER_OR) {
    text(in->group == CONDITION_INNER_AND ? " AND " : " OR ");
  } else {
    statement_name(WORD_KEY(14, 0, in->group));
    put('(');
  }
  if (expression_text_last(&list.x, &right) && expression_text_before(&list.x, right, &left)) {
    expression_text_put(&list.x, left, put);
    text(comparators[in->number & CONDITION_COMPARATOR]);
    expression_text_put(&list.x, right, put);
  } else {
    put('?');
  }
  if ((in->number & CONDITION_MORE) == 0) put(')');
}

/* Three and more in a row are a range: so a line does not list longer than it was entered. */
static void numbers(uint32_t mask, uint32_t first) {
  bool any = false;
  for (uint32_t i = 0; i < 32; i++) {
    if ((mask >> i & 1u) == 0) continue;
    uint32_t last = i;
    while (last < 31 && (mask >> (last + 1u) & 1u) != 0) last++;
    if (last < i + 2u) last = i;
    if (any) put(',');
    integer_text(i + first, put);
    if (last != i) {
      put('.');
      put('.');
      integer_text(last + first, put);
    }
    any = true;
    i = last;
  }
}

static void display_value(uint32_t number) {
  uint32_t root;
  integer_text(number & 0xFFu, put);
  put(',');
  integer_text(number >> DISPLAY_WIDTH_BIT & 0xFFu, put);
  put('.');
  integer_text(number >> DISPLAY_DECIMALS_BIT & 0xFFu, put);
  put(',');
  if (expression_text_last(&list.x, &root))
    expression(root);
  else
    put('?');
}

static void letters(uint32_t mask) {
  char before = '(';
  for (uint32_t i = 0; i < 26; i++) {
    if ((mask >> i & 1u) == 0) continue;
    put(before);
    put((char)('A' + i));
    before = ',';
  }
  put(')');
}

static void address_part(char letter, uint32_t part) {
  if (part == 0) return;
  put(letter);
  if ((part & ADDRESS_VARIABLE) != 0) put('P');
  integer_text(part & (ADDRESS_VARIABLE - 1u), put);
}

static void address(uint32_t number) {
  address_part('#', statement_address_motor(number));
  address_part('&', statement_address_cs(number));
}

static void lock(uint32_t number) {
  integer_text(number & (LOCK_COUNT - 1u), put);
  text(",P");
  integer_text(number >> LOCK_VARIABLE_BIT, put);
}

static void item_list(const struct instruction* in) {
  const uint32_t code = in->group == DISPLAY_VALUE  ? WORD_KEY(9, 2, 10)
                        : in->group == LOCK_TELLING ? WORD_KEY(9, 0, 12)
                                                    : in->group;
  const struct statement_row* row = statement_row_of(code);
  statement_name(code);
  if (in->group == DISPLAY_VALUE)
    display_value(in->number);
  else if (in->group == LOCK_TELLING)
    lock(in->number);
  else if (row == 0)
    return;
  else if (row->argument == ARGUMENT_LETTERS)
    letters(in->number);
  else if (row->argument == ARGUMENT_ADDRESS)
    address(in->number);
  else
    numbers(in->number, row->argument == ARGUMENT_MOTORS ? 1 : 0);
}

/* What stands in quotes, or a control letter. `count` words are left of the line. */
static void quoted(const struct instruction* in, const word48_t* words, uint32_t count) {
  const uint32_t length = in->number & TEXT_LENGTH;
  const uint32_t control = in->number >> TEXT_CONTROL_BIT & 0xFFu, column = in->number >> TEXT_COLUMN_BIT & 0xFFu;
  statement_name(in->group);
  if (control != 0) {
    const char letter = (char)(control & 0x7Fu);
    put('^');
    put(letter < ' ' ? '?' : letter);
    return;
  }
  if (column != 0) integer_text(column - 1u, put);
  put('"');
  for (uint32_t i = 0; i < length && 1u + i / WORD_TEXT_CHARACTERS < count; i++) {
    const char c = (char)(words[1u + i / WORD_TEXT_CHARACTERS] >> 8u * (i % WORD_TEXT_CHARACTERS) & 0x7Fu);
    put(c < ' ' ? '?' : c);
  }
  put('"');
}

/* The statement that begins or ends with `in`. */
static void statement(const struct instruction* in, const word48_t* words, uint32_t count) {
  struct instruction constant_in = *in;
  switch (in->operation) {
    case OP_AXIS:
    case OP_AXIS_POP:
      statement_name(WORD_KEY(1, 0, in->number & 0x3FFu));
      value(in);
      break;
    case OP_RATE:
    case OP_RATE_POP:
      statement_name(WORD_KEY(3, 0, in->number & 0x3FFu));
      value(in);
      break;
    case OP_MODE:
      statement_name(WORD_KEY(2, 0, in->number));
      list.blank_due = true;
      break;
    case OP_ABS:
      axis_list(WORD_KEY(2, 1, 0), in->number, AXIS_ALL);
      break;
    case OP_INC:
      axis_list(WORD_KEY(2, 2, 0), in->number, AXIS_ALL);
      break;
    case OP_FRAX:
      axis_list(WORD_KEY(2, 3, in->number == 0), in->number, in->number == 0 ? 0 : AXIS_XYZ);
      break;
    case OP_ASSIGN:
      put(expression_classes[in->group % VARIABLE_CLASSES]);
      integer_text(in->number + list.prefix, put);
      put('=');
      constant_in.group = 0;
      constant(&constant_in, in->value);
      break;
    case OP_ASSIGN_POP:
    case OP_ASSIGN_INDEXED:
      assignment(expression_classes[in->group % VARIABLE_CLASSES], in, in->operation == OP_ASSIGN_INDEXED, "=");
      break;
    case OP_SYNCHRONOUS:
    case OP_SYNCHRONOUS_INDEXED: {
      static const char* const equals[SYNCHRONOUS_COUNT] = {"==", "&=", "|=", "^="};
      assignment('M', in, in->operation == OP_SYNCHRONOUS_INDEXED, equals[in->group % SYNCHRONOUS_COUNT]);
      break;
    }
    case OP_STATEMENT:
    case OP_STATEMENT_POP:
      plain(in);
      break;
    case OP_CONDITION:
      condition(in);
      break;
    case OP_LIST:
      item_list(in);
      break;
    case OP_TEXT:
      quoted(in, words, count);
      break;
    case OP_BLANK:
      break;
    default:
      put('?');
      break;
  }
}

static void line(const word48_t* words, uint32_t count, bool long_form, void (*put_text)(char c)) {
  list.put = put_text;
  list.long_form = long_form;
  list.blank_due = list.in_hexadecimal = false;
  list.prefix = 0;
  list.x.words = words;
  list.x.count = 0;
  for (uint32_t at = 0; at < count;) {
    const struct instruction in = word_decode(words[at]);
    const uint32_t taken = 1u + word_raw_count(&in);
    const bool complete = taken <= count - at;
    if (in.operation == OP_PREFIX) {
      list.prefix = in.number << 10;
    } else if (!complete && in.operation == OP_PUSH_DOUBLE) {
      put('?');
    } else if (!expression_text_add(&list.x, at)) {
      const bool inner = in.operation == OP_CONDITION && in.group >= CONDITION_INNER_AND;
      const bool second = in.operation == OP_STATEMENT || in.operation == OP_STATEMENT_POP
                              ? in.number >> 11 == (1u << 2 | 1u)
                              : false; /* WORD_KEY(1, 2, n) and (1, 3, n) belong to the axis before them */
      if ((list.blank_due || list.in_hexadecimal) && !inner && !second) put(' ');
      list.blank_due = false;
      statement(&in, words + at, count - at);
      list.x.count = 0;
      list.prefix = 0;
    }
    at += taken;
  }
}

static uint32_t counted;

static void count_character(char c) {
  (void)c;
  counted++;
}

static uint32_t length(const word48_t* words, uint32_t count, bool long_form) {
  counted = 0;
  line(words, count, long_form, count_character);
  return counted;
}

uint32_t lister_length(const word48_t* words, uint32_t count) { return length(words, count, false); }

void lister_line(const word48_t* words, uint32_t count, bool long_form, void (*put_text)(char c)) {
  line(words, count, long_form && length(words, count, true) <= LEXER_LINE_LIMIT, put_text);
}
