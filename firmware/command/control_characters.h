/* Control characters that report or act on motion (firmware:5.9). */
#ifndef FIRMWARE_COMMAND_CONTROL_CHARACTERS_H
#define FIRMWARE_COMMAND_CONTROL_CHARACTERS_H

#include <stdbool.h>
#include <stdint.h>

bool control_character(uint8_t c); /* true: it sent data lines, an acknowledgement is due */

#endif
