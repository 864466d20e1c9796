/* Direct access to PMAC words (firmware:1.9): R and W of X, Y, L, D words. */
#ifndef FIRMWARE_COMMAND_MEMORY_COMMANDS_H
#define FIRMWARE_COMMAND_MEMORY_COMMANDS_H

#include "firmware/command/command.h"

extern const struct command_entry memory_commands[];

#endif
