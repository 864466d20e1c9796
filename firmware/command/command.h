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

error_t command_line(const char* line); /* upper-cased, without CR */
uint32_t command_cs(void);              /* addressed coordinate system, 0..15 */
uint32_t command_motor(void);           /* addressed motor, 0..31 */
uint32_t command_motor_group(void);     /* ##n: 0..3, the eight motors of ^B ^F ^P ^V */
void command_initialize(void);          /* addresses &1 #1 ##0 */
uint32_t command_generation(void);      /* counts changes of the addressed C.S., for BREQ */

#endif
