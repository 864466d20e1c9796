/* Commands of programs and axes: DEFINE DELETE B R S Q A PR ABS ... */
#ifndef FIRMWARE_COMMAND_PROGRAM_COMMANDS_H
#define FIRMWARE_COMMAND_PROGRAM_COMMANDS_H

#include "firmware/command/command.h"

extern const struct command_entry program_commands[];

#endif
