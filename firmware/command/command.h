/* The command interpreter: splits a host line into commands and runs them left to right. */
#ifndef FIRMWARE_COMMAND_COMMAND_H
#define FIRMWARE_COMMAND_COMMAND_H

#include "firmware/language/lexer.h"

/* `keyword` upper case, longest first inside a table; `run` is entered with the keyword consumed. The table ends with a
 * null keyword. */
struct command_entry {
  const char* keyword;
  error_t (*run)(struct lexer* lx);
};

extern const struct command_entry* const command_tables[]; /* null at the end; image/tables.c */

error_t command_line(const char* line); /* upper-cased, without CR */

#endif
