/* $$$ $$$*** SAVE ... */
#ifndef FIRMWARE_IMAGE_SYSTEM_COMMANDS_H
#define FIRMWARE_IMAGE_SYSTEM_COMMANDS_H

#include "firmware/command/command.h"

extern const struct command_entry system_commands[];

#endif
