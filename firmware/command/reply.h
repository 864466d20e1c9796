/* Replies to the command line being executed: data lines are framed by I3 and I4 as they are sent, errors by I6. What a
 * program sends, and what its commands answer, is marked by I64 (firmware:6.7). */
#ifndef FIRMWARE_COMMAND_REPLY_H
#define FIRMWARE_COMMAND_REPLY_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/error.h"

extern void (*const reply_sink)(uint8_t c); /* where characters go: a port (image/tables.c) */

enum reply_to { REPLY_TO_HOST, REPLY_TO_PROGRAM, REPLY_TO_NOBODY };
void reply_to(enum reply_to whom); /* for whom what follows is: the port is one, the form differs */

void reply_text(const char* text); /* appends to the current data line */
void reply_char(char c);
void reply_integer(int64_t value);
void reply_hex(uint32_t value, unsigned digits); /* upper case; digits 0 = minimal */
void reply_number(double value);                 /* up to 10 decimals, trailing zeros removed (firmware:1.6) */
bool reply_line_is_open(void);
void reply_end_line(void); /* ends the data line */
void reply_error(error_t error);

#endif
