/* `#n->...` and UNDEFINE (firmware:7.4), as on-line commands. */
#ifndef FIRMWARE_COMMAND_AXIS_COMMANDS_H
#define FIRMWARE_COMMAND_AXIS_COMMANDS_H

#include "firmware/language/lexer.h"

error_t axis_definition_command(struct lexer* lx); /* behind `->`: query or definition of the addressed motor */
error_t axis_undefine_command(struct lexer* lx);   /* UNDEFINE, UNDEFINE ALL */

#endif
