/* The statement table (statements.def) as compiler, lister and buffers read it. */
#ifndef FIRMWARE_LANGUAGE_STATEMENT_TABLE_H
#define FIRMWARE_LANGUAGE_STATEMENT_TABLE_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/language/word.h"

enum statement_argument {
  ARGUMENT_NONE,
  ARGUMENT_VALUE, /* a constant, or an expression in brackets */
  ARGUMENT_RATE,  /* the same; a constant is not negative */
  ARGUMENT_TIME,  /* nor longer than 8,388,607 ms */
  ARGUMENT_CODE,  /* a value that neither `->` nor a range follows: M1->, M1..5 are on-line commands */
  ARGUMENT_AXIS,
  ARGUMENT_LABEL,     /* 0 to 262,143 */
  ARGUMENT_AXES,      /* (X,Y,R); none: all */
  ARGUMENT_FRAX,      /* (X,Y); none: X, Y and Z */
  ARGUMENT_CONDITION, /* (P1>2 AND P3=4) */
  ARGUMENT_LETTERS,   /* (A,B) */
  ARGUMENT_MOTORS,    /* 1,3..5 */
  ARGUMENT_PLCS,
  ARGUMENT_ADDRESS, /* #1&2, #P400 */
  ARGUMENT_TEXT,    /* "text" or ^letter */
  ARGUMENT_DISPLAY, /* [column]"text" or column,width.decimals,variable */
  ARGUMENT_LOCK     /* number,P-variable; a value alone, as before there were locks */
};

enum statement_where {
  WHERE_PROG = 1,
  WHERE_ROTARY = 2,
  WHERE_PLC = 4,
  WHERE_KINEMATIC = 8,
  WHERE_MOVES = WHERE_PROG | WHERE_ROTARY,
  WHERE_LOGIC = WHERE_PROG | WHERE_PLC | WHERE_KINEMATIC, /* a ring of words cannot be jumped about in */
  WHERE_PLAIN = WHERE_PROG | WHERE_ROTARY | WHERE_PLC,
  WHERE_BEGUN = 0x20,  /* only behind another statement of its line: alone it is a command */
  WHERE_CALLED = 0x40, /* only behind a call on its line */
  CALLS = 0x80
};

struct statement_row {
  const char *name, *brief; /* brief 0: there is no shorter form */
  uint32_t code;
  uint8_t argument, where;
};

extern const struct statement_row statement_rows[];
extern const uint32_t statement_row_count;

const struct statement_row* statement_row_of(uint32_t code); /* 0: none */

#endif
