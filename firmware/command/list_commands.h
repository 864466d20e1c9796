/* LIST (firmware:4.8). */
#ifndef FIRMWARE_COMMAND_LIST_COMMANDS_H
#define FIRMWARE_COMMAND_LIST_COMMANDS_H

#include "firmware/command/command.h"

extern const struct command_entry list_commands[];

#endif
