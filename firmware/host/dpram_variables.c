/* The lists are the host's: what one says is checked where it is read, and an entry that leads out of the RAM is left
 * out. A set that is read is made in parts, a part a pass. */
#include "firmware/host/dpram_variables.h"

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/dpram.h"
#include "firmware/host/dpram_report.h"
#include "firmware/kernel/background.h"
#include "firmware/kernel/tasks.h"
#include "firmware/variables/dpram_use.h"
#include "firmware/variables/words.h"

enum { READ_ENTRY_BYTES = 4, LONG_BYTES = 8, ENTRIES_AT_ONCE = 16, WORD_BITS = 24 };
enum space { SPACE_Y, SPACE_LONG, SPACE_X, SPACE_DPRAM };

struct entry {
  uint32_t type; /* as the host has written it */
  enum space space;
  uint32_t address, lsb, width;
};

/* The set being made; the list that it began with. */
static struct {
  uint32_t size, start, control;
  uint32_t next, data; /* entry, and the offset of its data */
} set;

static bool is_on(void) { return i_integer(I55_DPRAM_VARIABLES) != 0 && dpram_is_used(); }

/* What the RAM holds at a start is no order to write. */
void dpram_variables_initialize(void) {
  set.size = 0;
  if (is_on()) dpram_write(DPRAM_WRITE_SIZE, 0);
}

static struct entry read_entry(uint32_t offset) {
  const uint32_t low = dpram_read(offset), type = dpram_read(offset + DPRAM_WORD_BYTES);
  const uint32_t width = type >> 2 & 0x1Fu, lsb = type >> 7 & 0x1Fu;
  const uint32_t there = lsb < WORD_BITS ? WORD_BITS - lsb : 0u;
  return (struct entry){type, (enum space)(type & 3u), low | (type >> 12 & 7u) << 16, lsb,
                        width == 0u || width > there ? there : width};
}

static bool is_inside(uint32_t offset, uint32_t bytes) { return offset + bytes <= dpram_bytes(); }

static uint32_t mask_of(const struct entry* e) { return (1u << e->width) - 1u; }

static bool is_in_ram(const struct entry* e) { return e->address - DPRAM_BASE < dpram_bytes() / DPRAM_ITEM_BYTES; }

/* To be read ------------------------------------------------------------------------------------------------------- */

/* A whole word is signed, a part of one is not. */
static uint32_t value(const struct entry* e) {
  const uint32_t word = word_read(e->space == SPACE_X, e->address);
  return e->width == WORD_BITS ? (uint32_t)hal_signed(word) : word >> e->lsb & mask_of(e);
}

static uint32_t item(const struct entry* e) {
  if (!is_in_ram(e)) return 0;
  const uint32_t low = word_read(false, e->address);
  return low | word_read(true, e->address) << 16;
}

static void show(const struct entry* e, uint32_t data) {
  if (e->space == SPACE_LONG) {
    uint32_t x, y;
    word_read_long(e->address, &x, &y);
    dpram_put_long(data, x, y);
  } else {
    dpram_write_item(data, e->space == SPACE_DPRAM ? item(e) : value(e));
  }
}

static void show_next(bool by_entry) {
  const uint32_t place = dpram_open_offset(set.start) + READ_ENTRY_BYTES * set.next++;
  const struct entry e = read_entry(place);
  const uint32_t bytes = e.space == SPACE_LONG ? LONG_BYTES : DPRAM_ITEM_BYTES, data = set.data;
  set.data += bytes;
  if (!is_inside(data, bytes) || (by_entry && (e.type & DPRAM_ENTRY_READY) != 0u)) return;
  show(&e, data);
  if (by_entry) dpram_write(place + DPRAM_WORD_BYTES, e.type | DPRAM_ENTRY_READY);
}

static void begin_set(uint32_t size, uint32_t start, uint32_t control) {
  set.size = size;
  set.start = start;
  set.control = control;
  set.next = 0;
  set.data = dpram_open_offset(start) + READ_ENTRY_BYTES * size;
}

static void read_pass(void) {
  const uint32_t size = dpram_read(DPRAM_READ_SIZE);
  if (size == 0u || size > DPRAM_READ_ENTRIES) {
    set.size = 0;
    return;
  }
  const uint32_t start = dpram_read(DPRAM_READ_START), control = dpram_read(DPRAM_READ_CONTROL);
  const bool by_entry = (control & DPRAM_READ_MULTI_USER) != 0u;
  if (!by_entry && (control & DPRAM_READ_READY) != 0u) return;
  if (!is_inside(dpram_open_offset(start), READ_ENTRY_BYTES * size)) return;
  if (size != set.size || start != set.start || control != set.control) begin_set(size, start, control);
  for (uint32_t count = 0; set.next < size && count < ENTRIES_AT_ONCE; ++count) show_next(by_entry);
  if (set.next < size) {
    background_wake();
    return;
  }
  dpram_write(DPRAM_READ_TIMER, tasks_servo_count());
  if (!by_entry) dpram_write(DPRAM_READ_CONTROL, control | DPRAM_READ_READY);
  set.size = 0;
}

/* To be written ---------------------------------------------------------------------------------------------------- */

static void take(const struct entry* e, uint32_t data) {
  const uint32_t low = dpram_read_item(data);
  if (e->space == SPACE_LONG) {
    word_write_long(e->address, dpram_read_item(data + DPRAM_ITEM_BYTES), low);
  } else if (e->space == SPACE_DPRAM) {
    if (!is_in_ram(e)) return;
    word_write(false, e->address, low & DPRAM_WORD_MASK);
    word_write(true, e->address, low >> 16);
  } else {
    word_write_part(e->space == SPACE_X, e->address, mask_of(e) << e->lsb, low << e->lsb);
  }
}

/* An address of 0 ends the list. */
static void write_pass(void) {
  const uint32_t size = dpram_read(DPRAM_WRITE_SIZE);
  if (size == 0u) return;
  const uint32_t list = dpram_open_offset(dpram_read(DPRAM_WRITE_START));
  const bool is_list = size <= DPRAM_WRITE_ENTRIES && is_inside(list, DPRAM_WRITE_ENTRY_BYTES * size);
  for (uint32_t i = 0; is_list && i < size; ++i) {
    const uint32_t place = list + DPRAM_WRITE_ENTRY_BYTES * i;
    const struct entry e = read_entry(place);
    if (e.address == 0u) break;
    take(&e, place + READ_ENTRY_BYTES);
  }
  dpram_write(DPRAM_WRITE_SIZE, 0);
}

void dpram_variables_pass(void) {
  if (!is_on()) {
    set.size = 0;
    return;
  }
  write_pass();
  read_pass();
}
