/* DEFINE, DELETE and LIST of compensation tables, and the constants that fill them. */
#ifndef FIRMWARE_COMMAND_TABLE_COMMANDS_H
#define FIRMWARE_COMMAND_TABLE_COMMANDS_H

#include "firmware/language/lexer.h"

/* Behind the command's keyword. False: it is no table that is named, nothing is consumed. */
bool table_define(struct lexer* lx, error_t* error);
bool table_delete(struct lexer* lx, error_t* error);
bool table_list(struct lexer* lx, error_t* error);

#endif
