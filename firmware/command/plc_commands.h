/* ENABLE, DISABLE, PAUSE and RESUME PLC on line (firmware:4.3). */
#ifndef FIRMWARE_COMMAND_PLC_COMMANDS_H
#define FIRMWARE_COMMAND_PLC_COMMANDS_H

#include "firmware/command/command.h"

extern const struct command_entry plc_commands[];

#endif
