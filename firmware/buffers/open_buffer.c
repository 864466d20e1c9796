/* Opening and closing of buffers. OPEN ROTARY opens all rotary buffers at once: from then on each takes part in BREQ.
 */
#include "firmware/buffers/open_buffer.h"

#include "firmware/base/dimensions.h"
#include "firmware/buffers/buffer_request.h"
#include "firmware/buffers/fixed_entry.h"
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

error_t open_buffer_open_fixed(enum fixed_kind kind, uint32_t number) {
  if (open_kind != OPEN_NONE) return ERR_BUFFER_OPEN;
  const error_t error = fixed_entry_begin(kind, number);
  if (error == ERR_NONE) open_kind = OPEN_FIXED;
  return error;
}

bool open_buffer_is_fixed(enum fixed_kind kind) {
  const struct fixed_program* program = fixed_program_opened();
  return program != 0 && program->kind == kind;
}

error_t open_buffer_close(void) {
  const enum open_buffer closed = open_kind;
  open_kind = OPEN_NONE;
  return closed == OPEN_FIXED ? fixed_entry_end() : ERR_NONE;
}
