/* TODAY and TIME (firmware:5.1). */
#ifndef FIRMWARE_COMMAND_CALENDAR_COMMANDS_H
#define FIRMWARE_COMMAND_CALENDAR_COMMANDS_H

#include "firmware/command/command.h"

extern const struct command_entry calendar_commands[];

#endif
