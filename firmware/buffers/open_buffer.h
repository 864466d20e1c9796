/* Which buffer is open for entry. One at a time, whatever its kind (ERR007). Background task. */
#ifndef FIRMWARE_BUFFERS_OPEN_BUFFER_H
#define FIRMWARE_BUFFERS_OPEN_BUFFER_H

#include "firmware/base/error.h"
#include "firmware/buffers/fixed_programs.h"

enum open_buffer { OPEN_NONE, OPEN_ROTARY, OPEN_BINARY_ROTARY, OPEN_FIXED };

void open_buffer_initialize(void);
enum open_buffer open_buffer_kind(void);
bool open_buffer_is_fixed(enum fixed_kind kind); /* such a fixed buffer is open */
error_t open_buffer_open(enum open_buffer kind); /* rotary: ERR007 if one is open, ERR003 without a rotary buffer */
error_t open_buffer_open_fixed(enum fixed_kind kind, uint32_t number); /* ERR007, ERR006 too many programs */
error_t open_buffer_close(void); /* ERR009: blocks of the fixed buffer are open; closed all the same */

#endif
