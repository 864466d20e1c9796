/* The active response port (host-bus:8.5): what a program sends without naming a port goes there. The last that has
 * brought a command, or after ^Z the serial port, which the boards do not have. Background task. */
#ifndef FIRMWARE_HOST_ACTIVE_PORT_H
#define FIRMWARE_HOST_ACTIVE_PORT_H

#include "firmware/run/program_output.h"

extern enum program_port active_port; /* PORT_PARALLEL, PORT_DPRAM or PORT_SERIAL */

enum { CONTROL_SERIAL_ACTIVE = 0x1A };

#endif
