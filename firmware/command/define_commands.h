/* DEFINE and DELETE of buffers, as on-line commands. */
#ifndef FIRMWARE_COMMAND_DEFINE_COMMANDS_H
#define FIRMWARE_COMMAND_DEFINE_COMMANDS_H

#include "firmware/language/lexer.h"

error_t define_command(struct lexer* lx); /* behind DEFINE or DEF */
error_t delete_command(struct lexer* lx); /* behind DELETE or DEL */

#endif
