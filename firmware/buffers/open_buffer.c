/* Opening and closing of buffers. OPEN ROTARY opens all rotary buffers at once: from then on each takes part in BREQ.
 */
#include "firmware/buffers/open_buffer.h"

#include "firmware/base/dimensions.h"
#include "firmware/buffers/buffer_request.h"
#include "firmware/buffers/rotary.h"

static enum open_buffer open_kind;

void open_buffer_initialize(void) { open_kind = OPEN_NONE; }

enum open_buffer open_buffer_kind(void) { return open_kind; }

error_t open_buffer_open(enum open_buffer kind) {
  if (open_kind != OPEN_NONE) return ERR_BUFFER_OPEN;
  if (!rotary_any()) return ERR_DATA;
  open_kind = kind;
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++)
    if (rotary_buffers[cs].size != 0) buffer_request_opened(cs);
  return ERR_NONE;
}

void open_buffer_close(void) { open_kind = OPEN_NONE; }
