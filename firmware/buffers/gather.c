/* What is gathered is looked up at GATHER, so a sample costs no more than its words do. In user memory a sample begins
 * with a long word of its own: words of 24 bits fill X and Y in turn, words of 48 bits a whole one. In the dual-ported
 * RAM each word of 24 bits is an item of 32. There a sample that begins in the buffer is stored whole, as far as there
 * is RAM; in user memory other buffers are behind it. */
#include "firmware/buffers/gather.h"

#include "firmware/base/dpram.h"
#include "firmware/base/memory_map.h"
#include "firmware/base/status.h"
#include "firmware/buffers/regions.h"
#include "firmware/buffers/user_memory.h"
#include "firmware/hal/hal.h"
#include "firmware/variables/dpram_use.h"
#include "firmware/variables/words.h"

enum { SOURCES = 48, MASK_BITS = 24, MODE_WRAPS = 1, MODE_DPRAM = 2, ADDRESS = 0x7FFFF };
enum { SOURCE_SHIFT = 22, SOURCE_Y = 0, SOURCE_X = 1 }; /* 2 and 3: both, fixed and floating point */

static struct {
  bool defined, in_dpram;
  uint32_t first; /* PMAC address of the first word */
  uint32_t size;  /* addresses */
  uint32_t end;   /* no sample goes beyond these */
} buffer;         /* B */

/* B, while the servo task is held off or nothing is gathered. */
static uint32_t sources[SOURCES], source_count, sample_size;
static bool is_plain[SOURCES]; /* read where it stands: no time is lost in the servo task */
static uint32_t period;        /* servo cycles; 0: once */
static bool wraps;

static volatile bool gathers; /* B; S ends it */
static uint32_t next;         /* address in the buffer. S, B while nothing is gathered */
static uint32_t left;         /* servo cycles to the next sample. S */
static bool was_full;         /* since the buffer was begun it has wrapped. S */

static void show(bool on) {
  gathers = on;
  status_show(STATUS_GATHERING, on);
}

static void show_pointer(void) {
  *hal_x(MEMORY_GATHER_POINTERS) = buffer.first;
  *hal_y(MEMORY_GATHER_POINTERS) = buffer.first + next;
  if (buffer.in_dpram) dpram_write(DPRAM_GATHER_POINTER, next);
}

void gather_initialize(void) {
  buffer.defined = false;
  show(false);
}

/* The buffer ------------------------------------------------------------------------------------------------------- */

static void begin_buffer(void) {
  next = 0;
  was_full = false;
  show_pointer();
}

static error_t define_in_dpram(uint32_t words) {
  if (!dpram_is_used()) return ERR_DATA;
  const uint32_t there_is = (dpram_bytes() - DPRAM_OPEN) / DPRAM_ITEM_BYTES;
  if (words > there_is) return ERR_NO_ROOM;
  buffer.size = words == GATHER_ALL_THERE_IS ? there_is : words;
  buffer.first = DPRAM_OPEN_ADDRESS;
  buffer.end = there_is;
  dpram_write(DPRAM_GATHER_SIZE, buffer.size);
  return ERR_NONE;
}

static error_t define_in_memory(uint32_t words) {
  const error_t error = words == GATHER_ALL_THERE_IS ? region_define_rest() : region_define(REGION_GATHER, 0, words);
  buffer.size = buffer.end = region_words(REGION_GATHER, 0);
  buffer.first = MEMORY_BUFFERS + region_base(REGION_GATHER, 0);
  return error;
}

error_t gather_define(uint32_t words) {
  if (gathers) return ERR_DATA;
  if (!buffer.defined) {
    const bool in_dpram = (i_integer(I5000_GATHER_MODE) & MODE_DPRAM) != 0;
    const error_t error = in_dpram ? define_in_dpram(words) : define_in_memory(words);
    if (error != ERR_NONE) return error;
    buffer.in_dpram = in_dpram;
    buffer.defined = true;
  }
  begin_buffer();
  return ERR_NONE;
}

void gather_delete_always(void) {
  gather_end();
  if (buffer.defined && buffer.in_dpram) dpram_write(DPRAM_GATHER_SIZE, 0);
  buffer.defined = false;
}

error_t gather_delete(void) {
  if (gathers) return ERR_DATA;
  gather_delete_always();
  return region_delete(REGION_GATHER, 0);
}

uint32_t gather_stored_words(void) {
  if (!buffer.defined || buffer.in_dpram) return 0;
  const uint32_t held = hal_mask_servo();
  const uint32_t words = was_full ? buffer.size : next;
  hal_unmask(held);
  return words;
}

/* Commands --------------------------------------------------------------------------------------------------------- */

static bool is_long(uint32_t source) { return source >> SOURCE_SHIFT > SOURCE_X; }

/* In addresses. */
static uint32_t size_of_sample(void) {
  uint32_t words = 0;
  bool half = false;
  for (uint32_t i = 0; i < source_count; ++i) {
    const bool both = is_long(sources[i]);
    if (buffer.in_dpram) {
      words += both ? 2u : 1u;
    } else if (both) {
      words += half ? 2u : 1u;
      half = false;
    } else {
      words += half ? 1u : 0u;
      half = !half;
    }
  }
  return half ? words + 1u : words;
}

static bool is_chosen(uint32_t source) {
  const uint32_t mask = (uint32_t)i_integer(I5050_GATHER_MASKS + source / MASK_BITS);
  return (mask >> source % MASK_BITS & 1u) != 0u;
}

static void look_up_sources(void) {
  source_count = 0;
  for (uint32_t i = 0; i < SOURCES; ++i)
    if (is_chosen(i)) {
      const uint32_t source = (uint32_t)i_integer(I5001_GATHER_SOURCES + i);
      is_plain[source_count] = word_is_plain(source & ADDRESS);
      sources[source_count++] = source;
    }
  sample_size = size_of_sample();
}

/* From where the next sample goes. */
static bool has_room(void) { return next < buffer.size && next + sample_size <= buffer.end; }

error_t gather_begin(void) {
  if (gathers) return ERR_NONE;
  if (!buffer.defined) return ERR_DATA;
  look_up_sources();
  wraps = (i_integer(I5000_GATHER_MODE) & MODE_WRAPS) != 0;
  period = (uint32_t)i_integer(I5049_GATHER_PERIOD);
  left = 0;
  if (source_count == 0u || !has_room()) return ERR_DATA;
  const uint32_t held = hal_mask_servo();
  show(true);
  hal_unmask(held);
  return ERR_NONE;
}

void gather_end(void) {
  const uint32_t held = hal_mask_servo();
  show(false);
  hal_unmask(held);
}

/* Samples ---------------------------------------------------------------------------------------------------------- */

struct pair {
  uint32_t x, y;
};

static struct pair read_both(uint32_t source, bool plain) {
  const uint32_t address = source & ADDRESS;
  struct pair word;
  if (plain) return (struct pair){*hal_x(address), *hal_y(address)};
  word_read_long(address, &word.x, &word.y);
  return word;
}

static uint32_t read_one(uint32_t source, bool plain) {
  const uint32_t address = source & ADDRESS;
  const bool x = source >> SOURCE_SHIFT == SOURCE_X;
  return plain ? *(x ? hal_x(address) : hal_y(address)) : word_read(x, address);
}

static uint32_t put_item(uint32_t at, uint32_t word) {
  dpram_write_item(dpram_open_offset(at), (uint32_t)hal_signed(word));
  return at + 1u;
}

static uint32_t sample_to_dpram(uint32_t at) {
  for (uint32_t i = 0; i < source_count; ++i) {
    if (!is_long(sources[i])) {
      at = put_item(at, read_one(sources[i], is_plain[i]));
      continue;
    }
    const struct pair word = read_both(sources[i], is_plain[i]);
    at = put_item(at, word.y);
    at = put_item(at, word.x);
  }
  return at;
}

static uint32_t put_long(uint32_t at, struct pair word) {
  *hal_x(buffer.first + at) = word.x;
  *hal_y(buffer.first + at) = word.y;
  return at + 1u;
}

static uint32_t sample_to_memory(uint32_t at) {
  struct pair begun = {0, 0};
  bool half = false;
  for (uint32_t i = 0; i < source_count; ++i) {
    if (is_long(sources[i])) {
      if (half) at = put_long(at, begun);
      half = false;
      at = put_long(at, read_both(sources[i], is_plain[i]));
    } else if (half) {
      begun.y = read_one(sources[i], is_plain[i]);
      at = put_long(at, begun);
      half = false;
    } else {
      begun = (struct pair){read_one(sources[i], is_plain[i]), 0};
      half = true;
    }
  }
  return half ? put_long(at, begun) : at;
}

static __attribute__((noinline)) void take_sample(void) {
  next = buffer.in_dpram ? sample_to_dpram(next) : sample_to_memory(next);
  if (!has_room() && wraps) {
    next = 0;
    was_full = true;
  }
  show_pointer();
  if (period == 0u || !has_room()) show(false);
}

void gather_servo(void) {
  if (!gathers) return;
  if (left != 0u) {
    --left;
    return;
  }
  left = period == 0u ? 0u : period - 1u;
  take_sample();
}

/* The sources as they are now ------------------------------------------------------------------------------------- */

static void put_bytes(void (*put)(uint8_t byte), uint32_t word) {
  for (int shift = 16; shift >= 0; shift -= 8) put((uint8_t)(word >> shift));
}

void gather_report_sources(void (*put)(uint8_t byte)) {
  for (uint32_t i = 0; i < SOURCES; ++i) {
    if (!is_chosen(i)) continue;
    const uint32_t source = (uint32_t)i_integer(I5001_GATHER_SOURCES + i);
    if (!is_long(source)) {
      put_bytes(put, read_one(source, false));
      continue;
    }
    const struct pair word = read_both(source, false);
    put_bytes(put, word.x);
    put_bytes(put, word.y);
  }
}
