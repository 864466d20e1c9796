/* I-, P-, Q- and M-variables on line (firmware:1.4, firmware:1.5). */
#ifndef FIRMWARE_COMMAND_VARIABLE_COMMANDS_H
#define FIRMWARE_COMMAND_VARIABLE_COMMANDS_H

#include "firmware/language/lexer.h"

/* Query or assignment; the letter is consumed, a digit or `(` comes next. */
error_t variable_command(struct lexer* lx, char letter);

#endif
