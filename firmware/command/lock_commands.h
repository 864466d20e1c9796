/* LOCK and UNLOCK on line. */
#ifndef FIRMWARE_COMMAND_LOCK_COMMANDS_H
#define FIRMWARE_COMMAND_LOCK_COMMANDS_H

#include "firmware/command/command.h"

extern const struct command_entry lock_commands[];

#endif
