/* On-line commands of motors (firmware:9.4, firmware:5.10): jog, home, kill, open loop, phase reference. */
#ifndef FIRMWARE_COMMAND_MOTOR_COMMANDS_H
#define FIRMWARE_COMMAND_MOTOR_COMMANDS_H

#include <stdint.h>

#include "firmware/command/command.h"

/* What the control panel asks for too, of a motor 0..31. Closes its loop. */
enum motor_jog { MOTOR_JOG_PLUS, MOTOR_JOG_MINUS, MOTOR_JOG_STOP, MOTOR_JOG_BACK, MOTOR_HOME };
error_t motor_jog(uint32_t motor, enum motor_jog how);

extern const struct command_entry motor_commands[];

#endif
