/* OPEN, CLOSE, CLEAR, SIZE (firmware:4.3). */
#ifndef FIRMWARE_COMMAND_BUFFER_COMMANDS_H
#define FIRMWARE_COMMAND_BUFFER_COMMANDS_H

#include "firmware/command/command.h"

extern const struct command_entry buffer_commands[];

#endif
