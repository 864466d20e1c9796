/* What the line input needs of the reply writer beyond reply.h. */
#ifndef FIRMWARE_COMMAND_REPLY_FRAME_H
#define FIRMWARE_COMMAND_REPLY_FRAME_H

#include <stdbool.h>

bool reply_line_is_open(void);

#endif
