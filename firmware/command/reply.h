/* Replies to the host line being executed: data lines are collected, framing by I3 is added when they are sent. */
#ifndef FIRMWARE_COMMAND_REPLY_H
#define FIRMWARE_COMMAND_REPLY_H

#include <stdbool.h>
#include <stdint.h>

extern void (*const reply_sink)(uint8_t c); /* where characters go: a port (image/tables.c) */

void reply_text(const char* text); /* appends to the current data line */
void reply_char(char c);
void reply_integer(int64_t value);
void reply_hex(uint32_t value, unsigned digits); /* upper case; digits 0 = minimal */
void reply_number(double value);                 /* up to 10 decimals, trailing zeros removed (firmware:1.6) */
bool reply_line_is_open(void);
void reply_end_line(void); /* ends the data line */

#endif
