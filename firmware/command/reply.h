/* Replies to the command line being executed: data lines are framed by I3 and I4 as they are sent, errors by I6. What a
 * program sends, and what its commands answer, is marked by I64 (firmware:6.7). The dual-ported RAM takes whole lines,
 * each with a code that says what it is, and none of that framing (host-bus:6.6). */
#ifndef FIRMWARE_COMMAND_REPLY_H
#define FIRMWARE_COMMAND_REPLY_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/error.h"

extern void (*const reply_sink)(uint8_t c); /* where characters go: a port (image/tables.c) */

struct reply_lines { /* `code`: a DPRAM_RESPONSE_... */
  void (*put)(uint32_t code, uint8_t c);
  void (*end)(uint32_t code);
};
extern const struct reply_lines reply_lines; /* the port that takes lines (image/tables.c) */

/* A line of many reports or assignments may take seconds: called behind each of them (image/tables.c). */
extern void (*const reply_between_lines)(void);

/* For whom what follows is, which says where it goes and its form: a command's answer, that of a program's command, and
 * through the dual-ported RAM also its texts. */
enum reply_to {
  REPLY_TO_HOST,
  REPLY_TO_PROGRAM,
  REPLY_TO_NOBODY,
  REPLY_TO_DPRAM,
  REPLY_TO_DPRAM_PROGRAM,
  REPLY_TO_DPRAM_TEXT
};
void reply_to(enum reply_to whom);

void reply_text(const char* text); /* appends to the current data line */
void reply_char(char c);
void reply_byte(uint8_t byte); /* binary: no framing around it, but for the port that takes lines */
void reply_integer(int64_t value);
void reply_hex(uint32_t value, unsigned digits); /* upper case; digits 0 = minimal */
void reply_number(double value);                 /* up to 10 decimals, trailing zeros removed (firmware:1.6) */
bool reply_line_is_open(void);
void reply_end_line(void);       /* ends the data line */
void reply_no_line(void);        /* a query that has none to show */
uint32_t reply_line_count(void); /* data lines so far, of any recipient, and queries without; wraps */
void reply_error(error_t error);

#endif
