#ifndef FIRMWARE_COMMAND_PHASE_COMMANDS_H
#define FIRMWARE_COMMAND_PHASE_COMMANDS_H

#include "firmware/command/command.h"

extern const struct command_entry phase_commands[]; /* SETPHASE */

#endif
