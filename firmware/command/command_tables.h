/* Tables and parts of the command interpreter (command/command.c). */
#ifndef FIRMWARE_COMMAND_COMMAND_TABLES_H
#define FIRMWARE_COMMAND_COMMAND_TABLES_H

#include "firmware/command/command.h"

extern const struct command_entry report_commands[]; /* ? ?? ??? P V F VER TYPE CID CPU ... */
extern const struct command_entry system_commands[]; /* $$$ $$$*** SAVE ... */
extern const struct command_entry memory_commands[]; /* R and W of X, Y, L, D words */

/* Query or assignment of I-, P-, Q- or M-variables; the letter is consumed, a digit or `(` comes next. */
error_t variable_command(struct lexer* lx, char letter);

#endif
