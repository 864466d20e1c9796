/* Status and identification queries (firmware:5): ? ?? ??? P V F VER TYPE CID CPU ... */
#ifndef FIRMWARE_COMMAND_REPORT_COMMANDS_H
#define FIRMWARE_COMMAND_REPORT_COMMANDS_H

#include "firmware/command/command.h"

extern const struct command_entry report_commands[];

#endif
