/* Looks at fields, because arithmetic with doubles would take most of a transfer's time. */
#include "firmware/language/binary_word.h"

#include "firmware/language/statement_table.h"

enum { FRACTION_HALF = 0x400000, FRACTION_MINUS_ONE = 0x800000, FRACTION_MINUS_HALF = 0xC00000 };
enum { FRACTION_BITS = 23, TIME_BITS = 23, LABEL_BITS = 18 }; /* of the largest time and label */
enum { PREFIX_LIMIT = 7 };                                    /* VARIABLE_COUNT is 8 x 1024 */
enum { LIST_UNUSED = 0x380, LIST_HIGH = 0x60, LIST_STATEMENT = 0x1F };
#define LIST_LOW UINT64_C(0x3FFFFFFF)

struct command {
  uint32_t code1, code2, n, fraction;
  int32_t exponent;
};

static bool is_bare(const struct command* c) { return c->fraction == 0 && c->exponent == 0; }

/* At least a half and less than 1, or -1; zero is all zero. */
static bool is_normal(const struct command* c) {
  if (c->fraction == 0) return c->exponent == 0;
  return c->fraction >= FRACTION_HALF && c->fraction <= FRACTION_MINUS_HALF;
}

static bool is_negative(const struct command* c) { return c->fraction >= FRACTION_MINUS_ONE; }

static bool is_label(const struct command* c) {
  if (c->fraction == 0) return true;
  if (is_negative(c) || c->exponent < 1 || c->exponent > LABEL_BITS) return false;
  return (c->fraction & ((1u << (FRACTION_BITS - c->exponent)) - 1u)) == 0;
}

static enum binary_fault in_range(bool good) { return good ? BINARY_GOOD : BINARY_ARGUMENT; }

static enum binary_fault value(const struct command* c, uint32_t argument) {
  if (!is_normal(c)) return BINARY_ARGUMENT;
  switch (argument) {
    case ARGUMENT_NONE:
      return in_range(is_bare(c));
    case ARGUMENT_RATE:
      return in_range(!is_negative(c));
    case ARGUMENT_TIME:
      return in_range(!is_negative(c) && c->exponent <= TIME_BITS);
    case ARGUMENT_LABEL:
      return in_range(is_label(c));
    default:
      return BINARY_GOOD;
  }
}

static const struct statement_row* find(const struct binary_judge* judge, uint32_t code) {
  const struct statement_row* row = statement_row_of(code);
  if (row == 0 || (row->where & WHERE_ROTARY) == 0) return 0;
  if ((row->where & WHERE_BEGUN) != 0 && !judge->begun) return 0;
  return (row->where & WHERE_CALLED) != 0 && !judge->called ? 0 : row;
}

static enum binary_fault plain(struct binary_judge* judge, const struct command* c) {
  const struct statement_row* row = find(judge, WORD_KEY(c->code1, c->code2, c->n));
  if (row == 0) return BINARY_CODE;
  if ((row->where & CALLS) != 0) judge->called = true;
  return value(c, row->argument);
}

/* An axis, an arc vector, or what `^` and `:` say of the axis before. */
static enum binary_fault axis(struct binary_judge* judge, const struct command* c) {
  const uint32_t before = judge->axis;
  judge->axis = 0;
  if (c->code2 == 1) return plain(judge, c);
  if (c->code2 > 3 || c->n >= AXIS_COUNT || (c->code2 != 0 && before != c->n + 1u)) return BINARY_CODE;
  if (c->code2 == 0) judge->axis = c->n + 1u;
  return value(c, ARGUMENT_VALUE);
}

static enum binary_fault modal(struct binary_judge* judge, const struct command* c) {
  switch (c->code2) {
    case 0:
      return plain(judge, c);
    case 1: /* ABS, INC */
    case 2:
      return in_range(is_bare(c) && c->n != 0);
    case 3: /* FRAX; no axis: NOFRAX */
      return in_range(is_bare(c) && c->n <= AXIS_ALL);
    default:
      return BINARY_CODE;
  }
}

static enum binary_fault list(const struct binary_judge* judge, const struct command* c, word48_t word) {
  if ((c->n & LIST_UNUSED) != 0 || find(judge, WORD_KEY(c->code1, c->code2, c->n & LIST_STATEMENT)) == 0)
    return BINARY_CODE;
  return in_range((word & LIST_LOW) != 0 || (c->n & LIST_HIGH) != 0);
}

static enum binary_fault prefix(struct binary_judge* judge, const struct command* c) {
  if (c->code2 != 0 || judge->prefixed) return BINARY_CODE;
  judge->prefixed = true;
  return in_range(is_bare(c) && c->n != 0 && c->n <= PREFIX_LIMIT);
}

static enum binary_fault assignment(struct binary_judge* judge, const struct command* c) {
  judge->prefixed = false;
  if (c->code2 > (c->code1 == 4 ? SYNCHRONOUS_COUNT : 0u)) return BINARY_CODE;
  return value(c, ARGUMENT_VALUE);
}

static enum binary_fault check(struct binary_judge* judge, const struct command* c, word48_t word) {
  if (c->code1 == 1) return judge->prefixed ? BINARY_CODE : axis(judge, c);
  judge->axis = 0;
  if (c->code1 >= 4 && c->code1 <= 7) return assignment(judge, c);
  if (judge->prefixed) return BINARY_CODE;
  switch (c->code1) {
    case 0:
      return c->code2 == 0 && c->n == 0 && is_bare(c) ? BINARY_GOOD : BINARY_CODE;
    case 2:
      return modal(judge, c);
    case 3:
    case 8:
      return c->code2 == 0 ? plain(judge, c) : BINARY_CODE;
    case 9:
      if (c->code2 == 1) return list(judge, c, word);
      return c->code2 == 0 ? plain(judge, c) : BINARY_CODE;
    case 15:
      return prefix(judge, c);
    default:
      return BINARY_CODE;
  }
}

enum binary_fault binary_judge_word(struct binary_judge* judge, word48_t word) {
  const uint32_t high = (uint32_t)(word >> 24);
  const struct command c = {.code1 = high >> 19 & 0xFu,
                            .code2 = high >> 16 & 7u,
                            .n = high >> 6 & 0x3FFu,
                            .fraction = (uint32_t)word & 0xFFFFFFu,
                            .exponent = (int32_t)((high & 0x3Fu) ^ 0x20u) - 0x20};
  const enum binary_fault fault = check(judge, &c, word);
  judge->begun = true;
  return fault;
}

enum binary_fault binary_judge_end(const struct binary_judge* judge) {
  return judge->prefixed ? BINARY_INCOMPLETE : BINARY_GOOD;
}
