/* Which buffer is open for entry. One at a time, whatever its kind (ERR007). Background task. */
#ifndef FIRMWARE_BUFFERS_OPEN_BUFFER_H
#define FIRMWARE_BUFFERS_OPEN_BUFFER_H

#include "firmware/base/error.h"

enum open_buffer { OPEN_NONE, OPEN_ROTARY, OPEN_BINARY_ROTARY };

void open_buffer_initialize(void);
enum open_buffer open_buffer_kind(void);
error_t open_buffer_open(enum open_buffer kind); /* ERR007 if one is open, ERR003 without a rotary buffer */
void open_buffer_close(void);

#endif
