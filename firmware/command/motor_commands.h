/* On-line commands of motors (firmware:9.4, firmware:5.10): jog, home, kill, open loop, phase reference. */
#ifndef FIRMWARE_COMMAND_MOTOR_COMMANDS_H
#define FIRMWARE_COMMAND_MOTOR_COMMANDS_H

#include "firmware/command/command.h"

extern const struct command_entry motor_commands[];

#endif
