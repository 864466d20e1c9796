/* Coding of program words.
 *   bits    47   46..43  42..40  39..30  29..24       23..0
 *   field   SOL  CODE1   CODE2   N       EXP (s6)     mantissa (s24, fraction of 23 bits) or an integer
 * Wide constants (CODE1 10 to 13) use the 45 bits below SOL, counted from CODE1 = 10, as kind(5) exponent(s7)
 * mantissa(s33). */
#include "firmware/language/word.h"

#include "firmware/base/mathematics.h"

enum code1 {
  CODE_BLANK = 0,
  CODE_AXIS = 1,
  CODE_MODAL = 2,
  CODE_RATE = 3,
  CODE_M = 4,
  CODE_I = 7,
  CODE_LETTER = 8,
  CODE_CALL = 9,
  CODE_WIDE = 10,
  CODE_WIDE_LAST = 13,
  CODE_STACK = 14,
  CODE_PREFIX = 15
};
enum modal { MODAL_MODE, MODAL_ABS, MODAL_INC, MODAL_FRAX };
enum wide { WIDE_AXIS = 0, WIDE_RATE = 9, WIDE_HEXADECIMAL = 16, WIDE_PUSH = 31 }; /* the 16 is turned over */
enum call { CALL_PLAIN, CALL_LIST, CALL_TEXT };
enum { LIST_WORD_BITS = 30, LIST_STATEMENT_BITS = 5 }; /* the list's other two bits are above those of the statement */
enum stack { STACK_APPLY, STACK_STATEMENT, STACK_CONDITION, STACK_SYNCHRONOUS, STACK_SYNCHRONOUS_INDEXED };
enum { CONDITION_BITS = 4, SYNCHRONOUS_BITS = 13 }; /* what the group stands above, in the low half */
enum { SHORT_FRACTION = 23, WIDE_FRACTION = 32 };

enum { TAIL_BITS = 47 };
#define TAIL_MASK (WORD_START_OF_LINE - 1u)
#define HEAD_MASK ((UINT64_C(1) << (64 - TAIL_BITS)) - 1u)

union double_bits {
  double value;
  uint64_t bits;
};

#define FIELD(word, low, width) ((uint32_t)((word) >> (low)) & ((1u << (width)) - 1u))

static const struct {
  uint8_t code2;
  uint8_t operation;
} STACK_CODES[] = {{0, OP_APPLY},    {1, OP_PUSH_VARIABLE}, {2, OP_PUSH_INDEXED}, {3, OP_PUSH_DOUBLE},
                   {4, OP_AXIS_POP}, {5, OP_RATE_POP},      {6, OP_ASSIGN_POP},   {7, OP_ASSIGN_INDEXED}};

static double fraction(uint64_t field, unsigned bits, int exponent) { /* signed fraction of `bits` bits and a sign */
  uint64_t sign = UINT64_C(1) << bits;
  return math_from_fixed((int64_t)(field ^ sign) - (int64_t)sign, exponent - (int)bits);
}

static word48_t fields(uint32_t code1, uint32_t code2, uint32_t n, uint32_t low) {
  return ((word48_t)code1 << 43) | ((word48_t)code2 << 40) | ((word48_t)(n & 0x3FFu) << 30) | (low & 0xFFFFFFu);
}

/* The usual constant: its fraction has 20 bits, the upper half of the double. False: pack has to find out. */
static bool pack_short(double value, uint32_t* mantissa, uint32_t* exponent) {
  const union double_bits d = {value};
  const uint32_t high = (uint32_t)(d.bits >> 32);
  const int e = (int)((high >> 20) & 0x7FFu) - 1022;
  if ((uint32_t)d.bits != 0 || e < -31 || e > 31) return false;
  const uint32_t magnitude = (0x100000u | (high & 0xFFFFFu)) << 2;
  *mantissa = ((high >> 31) != 0 ? 0u - magnitude : magnitude) & 0xFFFFFFu;
  *exponent = (uint32_t)e;
  return true;
}

/* Mantissa and exponent of value in `bits` fraction bits. False: rounded, or the exponent does not fit. */
static bool pack(double value, unsigned bits, int exponent_limit, uint64_t* mantissa, uint32_t* exponent) {
  int64_t m;
  int e;
  bool exact = math_to_fixed(value, bits, &m, &e);
  if (e < -exponent_limit) {
    exact = false;
    m = 0;
    e = 0;
  }
  *mantissa = (uint64_t)m & ((UINT64_C(2) << bits) - 1u);
  *exponent = (uint32_t)e;
  return exact && e < exponent_limit;
}

static word48_t encode_wide(uint32_t kind, double value) {
  uint64_t mantissa;
  uint32_t exponent;
  (void)pack(value, WIDE_FRACTION, 64, &mantissa, &exponent);
  word48_t body = ((word48_t)kind << 40) | ((word48_t)(exponent & 0x7Fu) << 33) | mantissa;
  return body + ((word48_t)CODE_WIDE << 43);
}

/* Inlined: the usual constant of an axis is packed within the time to BREQ. */
static inline __attribute__((always_inline)) bool encode_short(uint32_t code1, uint32_t code2, uint32_t n, double value,
                                                               word48_t* word) {
  uint64_t mantissa;
  uint32_t exponent, short_mantissa;
  if (!pack_short(value, &short_mantissa, &exponent)) {
    if (!pack(value, SHORT_FRACTION, 32, &mantissa, &exponent)) return false;
    short_mantissa = (uint32_t)mantissa;
  }
  *word = fields(code1, code2, n, short_mantissa) | ((word48_t)(exponent & 0x3Fu) << 24);
  return true;
}

/* A value that has to be rounded may become a short one: it takes the short form then, as it will when its listing is
 * downloaded. */
static word48_t encode_value(uint32_t code1, const struct instruction* in, uint32_t wide_kind) {
  word48_t word;
  if (in->group != 0) return encode_wide(wide_kind ^ WIDE_HEXADECIMAL, in->value);
  if (encode_short(code1, 0, in->number, in->value, &word)) return word;
  const word48_t wide = encode_wide(wide_kind, in->value);
  return encode_short(code1, 0, in->number, word_decode(wide).value, &word) ? word : wide;
}

word48_t word_axis(uint32_t axis, bool negative, uint32_t mantissa, int32_t exponent) {
  const unsigned below = WIDE_FRACTION - SHORT_FRACTION;
  if ((mantissa & ((1u << below) - 1u)) == 0) {
    const uint32_t magnitude = mantissa >> below;
    return fields(CODE_AXIS, 0, axis, negative ? 0u - magnitude : magnitude) | ((uint32_t)exponent & 0x3Fu) << 24;
  }
  const uint32_t high = (uint32_t)(CODE_WIDE << 11) + ((WIDE_AXIS + axis) << 8) + (((uint32_t)exponent & 0x7Fu) << 1);
  return (word48_t)(high | negative) << 32 | (negative ? 0u - mantissa : mantissa);
}

/* Operations of the stack code whose group is not in N. */
static word48_t encode_stack(enum stack stack, uint32_t low) { return fields(CODE_STACK, 0, stack, low); }

bool word_holds_exactly(double value) {
  uint64_t mantissa;
  uint32_t exponent;
  return pack(value, WIDE_FRACTION, 64, &mantissa, &exponent);
}

bool word_holds_short(double value) {
  uint64_t mantissa;
  uint32_t exponent;
  return pack(value, SHORT_FRACTION, 32, &mantissa, &exponent);
}

word48_t word_encode(const struct instruction* in) {
  word48_t word;
  switch (in->operation) {
    case OP_AXIS:
      return encode_value(CODE_AXIS, in, WIDE_AXIS + in->number);
    case OP_RATE:
      return encode_value(CODE_RATE, in, WIDE_RATE + in->number);
    case OP_ASSIGN:
      return encode_short(CODE_M + in->group, 0, in->number, in->value, &word) ? word : 0;
    case OP_STATEMENT:
      return encode_short(in->number >> 13, (in->number >> 10) & 7u, in->number & 0x3FFu, in->value, &word) ? word : 0;
    case OP_PUSH:
      return encode_wide(in->group != 0 ? WIDE_PUSH ^ WIDE_HEXADECIMAL : WIDE_PUSH, in->value);
    case OP_STATEMENT_POP:
      return encode_stack(STACK_STATEMENT, in->number);
    case OP_CONDITION:
      return encode_stack(STACK_CONDITION, in->group << CONDITION_BITS | in->number);
    case OP_SYNCHRONOUS:
      return encode_stack(STACK_SYNCHRONOUS, in->group << SYNCHRONOUS_BITS | in->number);
    case OP_SYNCHRONOUS_INDEXED:
      return encode_stack(STACK_SYNCHRONOUS_INDEXED, in->group << SYNCHRONOUS_BITS);
    case OP_LIST:
      return fields(CODE_CALL, CALL_LIST, (in->group & 0x1Fu) | in->number >> LIST_WORD_BITS << LIST_STATEMENT_BITS,
                    0) |
             (in->number & ((1u << LIST_WORD_BITS) - 1u));
    case OP_TEXT:
      return fields(CODE_CALL, CALL_TEXT, in->group & 0x3FFu, in->number);
    case OP_MODE:
      return fields(CODE_MODAL, MODAL_MODE, in->number, 0);
    case OP_ABS:
      return fields(CODE_MODAL, MODAL_ABS, in->number, 0);
    case OP_INC:
      return fields(CODE_MODAL, MODAL_INC, in->number, 0);
    case OP_FRAX:
      return fields(CODE_MODAL, MODAL_FRAX, in->number, 0);
    case OP_PREFIX:
      return fields(CODE_PREFIX, 0, in->number, 0);
    default:
      break;
  }
  for (unsigned i = 0; i < sizeof STACK_CODES / sizeof STACK_CODES[0]; i++)
    if (STACK_CODES[i].operation == (uint8_t)in->operation)
      return fields(CODE_STACK, STACK_CODES[i].code2, in->group, in->number);
  return fields(CODE_BLANK, 0, 0, 0);
}

static struct instruction decode_wide(word48_t word) {
  struct instruction in = {OP_ILLEGAL, 0, 0, 0.0};
  word48_t body = (word & ~WORD_START_OF_LINE) - ((word48_t)CODE_WIDE << 43);
  uint32_t kind = FIELD(body, 40, 5), exponent = FIELD(body, 33, 7);
  in.value = fraction(body & ((UINT64_C(1) << 33) - 1u), WIDE_FRACTION, (int)(exponent ^ 0x40u) - 0x40);
  in.group = (kind & WIDE_HEXADECIMAL) != 0 && kind != WIDE_PUSH;
  if (kind == (WIDE_PUSH ^ WIDE_HEXADECIMAL)) in.group = 1;
  if (in.group != 0) kind ^= WIDE_HEXADECIMAL;
  if (kind < AXIS_COUNT) {
    in.operation = OP_AXIS;
    in.number = kind;
  } else if (kind - WIDE_RATE < RATE_COUNT) {
    in.operation = OP_RATE;
    in.number = kind - WIDE_RATE;
  } else if (kind == WIDE_PUSH) {
    in.operation = OP_PUSH;
  }
  return in;
}

static enum operation modal_operation(uint32_t code2, uint32_t n) {
  switch (code2) {
    case MODAL_MODE:
      return n <= MODE_RAPID ? OP_MODE : OP_ILLEGAL;
    case MODAL_ABS:
      return OP_ABS;
    case MODAL_INC:
      return OP_INC;
    case MODAL_FRAX:
      return OP_FRAX;
    default:
      return OP_ILLEGAL;
  }
}

/* Codes 14,0: operators, and what pops its operands without being an axis, rate or plain assignment. */
static struct instruction decode_stack(uint32_t n, uint32_t low) {
  struct instruction in = {OP_ILLEGAL, 0, low, 0.0};
  switch (n) {
    case STACK_APPLY:
      in.operation = OP_APPLY;
      break;
    case STACK_STATEMENT:
      in.operation = OP_STATEMENT_POP;
      break;
    case STACK_CONDITION:
      in.operation = OP_CONDITION;
      in.group = low >> CONDITION_BITS;
      in.number = low & ((1u << CONDITION_BITS) - 1u);
      if (in.group > CONDITION_INNER_OR) in.operation = OP_ILLEGAL;
      break;
    case STACK_SYNCHRONOUS:
    case STACK_SYNCHRONOUS_INDEXED:
      in.operation = n == STACK_SYNCHRONOUS ? OP_SYNCHRONOUS : OP_SYNCHRONOUS_INDEXED;
      in.group = low >> SYNCHRONOUS_BITS;
      in.number = low & ((1u << SYNCHRONOUS_BITS) - 1u);
      if (in.group >= SYNCHRONOUS_COUNT) in.operation = OP_ILLEGAL;
      break;
    default:
      break;
  }
  return in;
}

static struct instruction decode_call(word48_t word, uint32_t code2, uint32_t n) {
  struct instruction in = {OP_ILLEGAL, 0, 0, 0.0};
  if (code2 == CALL_LIST) {
    const uint32_t high = (n >> LIST_STATEMENT_BITS) & 3u;
    in.operation = OP_LIST;
    in.group = WORD_KEY(CODE_CALL, CALL_LIST, n & ((1u << LIST_STATEMENT_BITS) - 1u));
    in.number = ((uint32_t)word & ((1u << LIST_WORD_BITS) - 1u)) | high << LIST_WORD_BITS;
  } else if (code2 == CALL_TEXT) {
    in.operation = OP_TEXT;
    in.group = WORD_KEY(CODE_CALL, CALL_TEXT, n);
    in.number = (uint32_t)word & 0xFFFFFFu;
  }
  return in;
}

/* What the executor does not know yet, or never has to: statements by their code alone. */
static bool is_statement(uint32_t code1, uint32_t code2, uint32_t n) {
  switch (code1) {
    case CODE_AXIS:
      return (code2 == 1 && n < 4) || ((code2 == 2 || code2 == 3) && n < AXIS_COUNT);
    case CODE_MODAL:
      return code2 == MODAL_MODE && n > MODE_RAPID;
    case CODE_RATE:
      return code2 == 0 && n >= RATE_COUNT;
    case CODE_M:
      return code2 >= 1 && code2 <= 4;
    case CODE_LETTER:
    case CODE_CALL:
      return code2 == 0;
    default:
      return false;
  }
}

struct instruction word_decode(word48_t word) {
  uint32_t code1 = FIELD(word, 43, 4), code2 = FIELD(word, 40, 3), n = FIELD(word, 30, 10),
           exponent = FIELD(word, 24, 6);
  if (code1 >= CODE_WIDE && code1 <= CODE_WIDE_LAST) return decode_wide(word);
  if (code1 == CODE_STACK && code2 == 0) return decode_stack(n, (uint32_t)word & 0xFFFFFFu);
  if (code1 == CODE_CALL && code2 != CALL_PLAIN) return decode_call(word, code2, n);
  struct instruction in = {OP_ILLEGAL, 0, n, 0.0};
  if (code1 >= CODE_M && code1 <= CODE_I && code2 == 0) {
    in.operation = OP_ASSIGN;
    in.group = code1 - CODE_M; /* M, P, Q, I: the order of enum variable_class */
  }
  switch (code1) {
    case CODE_BLANK:
      if (code2 == 0 && n == 0) in.operation = OP_BLANK;
      break;
    case CODE_AXIS:
      if (code2 == 0 && n < AXIS_COUNT) in.operation = OP_AXIS;
      break;
    case CODE_RATE:
      if (code2 == 0 && n < RATE_COUNT) in.operation = OP_RATE;
      break;
    case CODE_MODAL:
      in.operation = modal_operation(code2, n);
      break;
    case CODE_STACK:
      in.operation = (enum operation)STACK_CODES[code2].operation;
      in.group = n;
      in.number = (uint32_t)word & 0xFFFFFFu;
      break;
    case CODE_PREFIX:
      in.operation = OP_PREFIX;
      break;
    default:
      break;
  }
  if (in.operation == OP_ILLEGAL && is_statement(code1, code2, n)) {
    in.operation = OP_STATEMENT;
    in.number = WORD_KEY(code1, code2, n);
  }
  if (in.operation == OP_AXIS || in.operation == OP_RATE || in.operation == OP_ASSIGN || in.operation == OP_STATEMENT)
    in.value = fraction(word & 0xFFFFFFu, SHORT_FRACTION, (int)(exponent ^ 0x20u) - 0x20);
  return in;
}

uint32_t word_raw_count(const struct instruction* in) {
  if (in->operation == OP_PUSH_DOUBLE) return 1;
  if (in->operation != OP_TEXT) return 0;
  return ((in->number & TEXT_LENGTH) + WORD_TEXT_CHARACTERS - 1u) / WORD_TEXT_CHARACTERS;
}

/* The tail has the bits below the mark of a line's start, so that it never looks like one. */
word48_t word_double_head(double value) {
  union double_bits d = {value};
  struct instruction in = {OP_PUSH_DOUBLE, 0, (uint32_t)(d.bits >> TAIL_BITS), 0.0};
  return word_encode(&in);
}

word48_t word_double_tail(double value) {
  union double_bits d = {value};
  return d.bits & TAIL_MASK;
}

double word_double_join(word48_t head, word48_t tail) {
  union double_bits d = {0.0};
  d.bits = ((head & HEAD_MASK) << TAIL_BITS) | (tail & TAIL_MASK);
  return d.value;
}
