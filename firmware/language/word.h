/* The 48-bit words in which program lines are stored: X half in bits 47..24, Y half in bits 23..0. The layout of codes
 * 0 to 9 and 15 is that of the binary rotary buffer (host-bus:7.7), so that lines copied from DPRAM need no
 * translation; codes 10 to 14 are for what that format cannot hold: constants of 33 bits, and expressions as a stack
 * program (docs/language.md). */
#ifndef FIRMWARE_LANGUAGE_WORD_H
#define FIRMWARE_LANGUAGE_WORD_H

#include <stdbool.h>
#include <stdint.h>

typedef uint64_t word48_t;

#define WORD48_MASK UINT64_C(0xFFFFFFFFFFFF)
#define WORD_START_OF_LINE (UINT64_C(1) << 47)      /* on the first word of each program line */
#define WORD_DOUBLE_HEXADECIMAL (UINT64_C(1) << 30) /* in the head of a double that was entered so */

enum axis { AXIS_A, AXIS_B, AXIS_C, AXIS_U, AXIS_V, AXIS_W, AXIS_X, AXIS_Y, AXIS_Z, AXIS_COUNT };

enum {
  AXIS_ALL = 0x1FF,
  AXIS_XYZ = 0x1C0,
  AXIS_VECTOR = 0x200 /* R in ABS(...) and INC(...): the arc vector */
};

enum rate { RATE_F, RATE_TM, RATE_TA, RATE_TS, RATE_DWELL, RATE_DELAY, RATE_COUNT };

/* In the order of their codes; OP_MODE is of the first two, the others are OP_STATEMENT. */
enum mode { MODE_LINEAR, MODE_RAPID, MODE_CIRCLE1, MODE_CIRCLE2, MODE_SPLINE1, MODE_SPLINE2, MODE_PVT };

enum variable_class { VARIABLE_M, VARIABLE_P, VARIABLE_Q, VARIABLE_I, VARIABLE_CLASSES };

enum operation {
  OP_ILLEGAL,
  OP_BLANK,
  OP_AXIS, /* number = axis, value */
  OP_RATE, /* number = rate, value */
  OP_MODE, /* number = mode */
  OP_ABS,  /* number = axis mask */
  OP_INC,
  OP_FRAX,
  OP_PREFIX,        /* number = bits 10 and up of the next command's variable number */
  OP_ASSIGN,        /* group, number 0..1023, value that word_holds_short */
  OP_PUSH,          /* value */
  OP_PUSH_DOUBLE,   /* value's upper 17 bits here, lower 47 in the next word, which is not an operation */
  OP_PUSH_VARIABLE, /* group, number */
  OP_PUSH_INDEXED,  /* group; pops the number */
  OP_APPLY,         /* number = enum operator_code; pops its operands, pushes the result */
  OP_AXIS_POP,      /* as OP_AXIS, OP_RATE, OP_ASSIGN, with the value popped */
  OP_RATE_POP,
  OP_ASSIGN_POP,
  OP_ASSIGN_INDEXED,      /* group; pops the value, then the number */
  OP_STATEMENT,           /* number = WORD_KEY of the statement, value that word_holds_short */
  OP_STATEMENT_POP,       /* the same with the value popped */
  OP_CONDITION,           /* group = enum condition, number = enum comparator and CONDITION_MORE; pops two values */
  OP_SYNCHRONOUS,         /* group = enum synchronous, number of the M-variable; pops the value. All synchronous M */
  OP_SYNCHRONOUS_INDEXED, /* group; pops the value, then the number */
  OP_LIST,                /* group = WORD_KEY of the statement, number: 32 bits, of motors, PLCs or letters */
  OP_TEXT                 /* group = WORD_KEY, number = 24 bits, length lowest (TEXT_...); raw words follow */
};

/* A statement by the fields that name it. */
#define WORD_KEY(code1, code2, n) ((uint32_t)(code1) << 13 | (uint32_t)(code2) << 10 | (uint32_t)(n))

enum condition { CONDITION_IF, CONDITION_WHILE, CONDITION_AND, CONDITION_OR, CONDITION_INNER_AND, CONDITION_INNER_OR };
enum { CONDITION_COMPARATOR = 7, CONDITION_MORE = 8 }; /* an inner AND or OR follows in the same brackets */

enum synchronous { SYNCHRONOUS_SET, SYNCHRONOUS_AND, SYNCHRONOUS_OR, SYNCHRONOUS_XOR, SYNCHRONOUS_COUNT };

enum { TEXT_LENGTH = 0xFF, TEXT_CONTROL_BIT = 8, TEXT_COLUMN_BIT = 16 }; /* control letter or 0; column + 1 or 0 */
enum { WORD_TEXT_CHARACTERS = 5 }; /* in a raw word behind OP_TEXT, the first one lowest */

struct instruction {
  enum operation operation;
  uint32_t group; /* of a constant: 1 when it was entered in hexadecimal, so that it is listed so */
  uint32_t number;
  double value;
};

struct instruction word_decode(word48_t word);
word48_t word_encode(const struct instruction* in); /* one word; a value is rounded to 33 bits when it has to be */
/* OP_AXIS of -+ mantissa / 2^32 x 2^exponent, without a double; the mantissa has its highest bit set, or is 0 and the
 * exponent too. */
word48_t word_axis(uint32_t axis, bool negative, uint32_t mantissa, int32_t exponent);
bool word_holds_exactly(double value);   /* OP_PUSH of this value loses nothing */
bool word_holds_short(double value);     /* nor does the 24-bit form of OP_ASSIGN, which has no wide form */
word48_t word_double_head(double value); /* OP_PUSH_DOUBLE and the raw word that follows it */
word48_t word_double_tail(double value);
double word_double_join(word48_t head, word48_t tail);
uint32_t word_raw_count(const struct instruction* in); /* words behind this one that are no operations */

#endif
