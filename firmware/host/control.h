/* Control characters that report or act on motion (firmware:5.9). */
#ifndef FIRMWARE_HOST_CONTROL_H
#define FIRMWARE_HOST_CONTROL_H

#include <stdbool.h>
#include <stdint.h>

bool control_character(uint8_t c); /* true: it sent data lines, an acknowledgement is due */

#endif
