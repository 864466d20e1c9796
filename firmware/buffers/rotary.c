/* Rotary buffers. The words of a line are written into free space first and published in one short section with the
 * real-time task held off, so the reader never sees half a line. */
#include "firmware/buffers/rotary.h"

#include "firmware/base/dimensions.h"
#include "firmware/base/memory_map.h"
#include "firmware/buffers/buffer_request.h"
#include "firmware/buffers/regions.h"
#include "firmware/buffers/user_memory.h"
#include "firmware/hal/hal.h"
#include "firmware/kernel/slice.h"

static volatile bool held; /* B, looked at by R */

/* Its fill, in the memory: under the mask. */
static void show(uint32_t cs) {
  const uint32_t address = MEMORY_CS_WORDS + MEMORY_CS_STRIDE * cs + MEMORY_CS_ROTARY;
  *hal_x(address) = rotary_buffers[cs].lines;
  *hal_y(address) = rotary_buffers[cs].used;
}

static void reset(uint32_t cs) {
  struct rotary* ring = &rotary_buffers[cs];
  ring->generation++;
  ring->write = ring->read = 0;
  ring->used = ring->lines = 0;
  show(cs);
}

static void forget(uint32_t cs) {
  struct rotary* ring = &rotary_buffers[cs];
  uint32_t state = hal_mask_real_time();
  reset(cs);
  ring->size = 0;
  ring->requested = false;
  buffer_request_emptied(cs);
  hal_unmask(state);
}

void rotary_initialize(void) {
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++) rotary_buffers[cs] = (struct rotary){0};
  held = false;
}

error_t rotary_define(uint32_t cs, uint32_t words) {
  error_t error = region_define(REGION_ROTARY, cs, words);
  if (error != ERR_NONE) return error;
  struct rotary* ring = &rotary_buffers[cs];
  const uint32_t base = region_base(REGION_ROTARY, cs);
  uint32_t state = hal_mask_real_time();
  reset(cs);
  ring->base = base;
  ring->size = words;
  ring->requested = false;
  buffer_request_emptied(cs);
  hal_unmask(state);
  return ERR_NONE;
}

error_t rotary_delete(uint32_t cs) {
  error_t error = region_delete(REGION_ROTARY, cs);
  if (error == ERR_NONE) forget(cs);
  return error;
}

void rotary_delete_all(void) {
  regions_delete_from(REGION_CCBUF);
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++) forget(cs);
}

bool rotary_any(void) {
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++)
    if (rotary_buffers[cs].size != 0) return true;
  return false;
}

void rotary_clear(uint32_t cs) {
  uint32_t state = hal_mask_real_time();
  reset(cs);
  buffer_request_emptied(cs);
  hal_unmask(state);
}

void rotary_hold(bool hold) { held = hold; }

uint32_t rotary_room(uint32_t cs) { return held ? 0 : rotary_buffers[cs].size - rotary_buffers[cs].used; }

void rotary_put(uint32_t cs, uint32_t ahead, word48_t word) {
  const struct rotary* ring = &rotary_buffers[cs];
  user_memory_write(ring->base + rotary_offset(cs, ring->write, ahead), word);
}

void rotary_publish(uint32_t cs, uint32_t count) {
  struct rotary* ring = &rotary_buffers[cs];
  const uint32_t write = rotary_offset(cs, ring->write, count);
  uint32_t state = hal_mask_all(); /* servo and phase task of eight motors together are longer than the pulse may be */
  buffer_request_begin_line(cs);
  ring->write = write;
  ring->used += count;
  ring->lines++;
  buffer_request_line_stored(cs);
  show(cs);
  hal_unmask(state);
}

error_t rotary_store(uint32_t cs, const word48_t* words, uint32_t count) {
  struct rotary* ring = &rotary_buffers[cs];
  if (count == 0 || count > ring->size - ring->used) return ERR_NO_ROOM; /* `used` can only fall meanwhile */
  ring->generation++;
  uint32_t write = ring->write;
  for (uint32_t i = 0; i < count; i++) {
    user_memory_write(ring->base + write, i == 0 ? words[0] | WORD_START_OF_LINE : words[i]);
    if (++write == ring->size) write = 0;
  }
  rotary_publish(cs, count);
  return ERR_NONE;
}

uint32_t rotary_offset(uint32_t cs, uint32_t offset, uint32_t ahead) {
  const uint32_t size = rotary_buffers[cs].size, sum = offset + ahead; /* ahead: no more than the size */
  return sum >= size ? sum - size : sum;
}

word48_t rotary_word(uint32_t cs, uint32_t offset) { return user_memory_read(rotary_buffers[cs].base + offset); }

struct rotary_lines rotary_lines_ahead(uint32_t cs) {
  const uint32_t state = hal_mask_real_time();
  struct rotary_lines lines = {rotary_buffers[cs].read, rotary_buffers[cs].used};
  hal_unmask(state);
  for (; lines.words != 0 && (rotary_word(cs, lines.offset) & WORD_START_OF_LINE) == 0; lines.words--)
    lines.offset = rotary_offset(cs, lines.offset, 1); /* the rest of the line under way */
  return lines;
}

bool rotary_peek(uint32_t cs, uint32_t ahead, word48_t* word) {
  const struct rotary* ring = &rotary_buffers[cs];
  if (ahead >= ring->used) return false;
  *word = rotary_word(cs, rotary_offset(cs, ring->read, ahead));
  return true;
}

bool rotary_consume(uint32_t cs, uint32_t count) {
  struct rotary* ring = &rotary_buffers[cs];
  word48_t next;
  ring->read += count;
  if (ring->read >= ring->size) ring->read -= ring->size;
  ring->used -= count;
  if (rotary_peek(cs, 0, &next) && (next & WORD_START_OF_LINE) == 0) return false;
  if (ring->used == 0)
    ring->lines = 0; /* also when a host has written over the marks */
  else if (ring->lines != 0)
    ring->lines--;
  show(cs);
  buffer_request_line_calculated(cs);
  return true;
}

void rotary_skip_line_rest(uint32_t cs) {
  word48_t next;
  while (rotary_peek(cs, 0, &next) && (next & WORD_START_OF_LINE) == 0) {
    if (rotary_consume(cs, 1)) break;
    slice_pause();
  }
}
