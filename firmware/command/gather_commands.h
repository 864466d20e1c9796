/* GATHER, ENDGATHER (firmware:4.3). */
#ifndef FIRMWARE_COMMAND_GATHER_COMMANDS_H
#define FIRMWARE_COMMAND_GATHER_COMMANDS_H

#include "firmware/command/command.h"

extern const struct command_entry gather_commands[];

#endif
