/* A header a coordinate system says where the lines stand. Words are taken one by one into the free space of the ring,
 * and counted when their line is complete, so that a line enters whole or not at all however often time runs out in the
 * middle of it. The host may write anything at any time: a word is read once, and judged before it is used. */
#include "firmware/host/binary_rotary.h"

#include "firmware/base/dimensions.h"
#include "firmware/base/dpram.h"
#include "firmware/buffers/open_buffer.h"
#include "firmware/buffers/rotary.h"
#include "firmware/hal/hal.h"
#include "firmware/kernel/background.h"
#include "firmware/kernel/tasks.h"
#include "firmware/language/binary_word.h"
#include "firmware/variables/i_variables.h"

enum { LEAST_SIZE = 6, COMMAND_ITEMS = 2 };
enum { END_OF_BUFFER = 0x000800, END_OF_BUFFER_SIGNED = 0xFF0800 }; /* host-bus:7.3, either form */
enum { FOREGROUND_PART = 4 }; /* of the time that the real-time task may calculate */

/* Codes of host-bus:7.5, and those of enum binary_fault. */
enum fault {
  FAULT_NONE = 0,
  FAULT_NO_BUFFER = 1,
  FAULT_SIZE = 2,
  FAULT_PLACE = 3,
  FAULT_INDEX = 4,
  FAULT_ENABLE = 7,
  FAULT_LENGTH = 9
};

/* What there is to do next for a header: go on, nothing, wait for room in the ring, wait for the host. */
enum step { STEP_DONE, STEP_EMPTY, STEP_BLOCKED, STEP_STOP };

struct header {
  uint32_t offset; /* of the header itself */
  uint32_t status, host_index, index, size, start;
};

/* A line of which words stand in the free space of the ring already, and what was true then. */
struct begun {
  uint32_t count, at; /* words of it; index of the next */
  uint32_t line, size, start, generation;
  struct binary_judge judge;
};

/* The task that copies owns all of this: the background, or the real-time task while `copying` is false. */
static volatile bool copying; /* B, looked at by R */
static struct begun begun[COORDINATE_SYSTEMS];
static uint32_t turn;            /* the coordinate system that is looked at first */
static uint32_t started, length; /* of this pass, CPU cycles */
static bool is_active;           /* something may come: a header is enabled, and nothing holds it */

static bool is_foreground(void) { return i_integer(I45_FOREGROUND_BINARY) != 0; }
static bool is_open(void) { return open_buffer_kind() == OPEN_BINARY_ROTARY; }
static bool time_is_over(void) { return hal_cycles() - started >= length; }

static uint32_t header_offset(uint32_t cs) { return DPRAM_ROTARY_HEADERS + cs * DPRAM_ROTARY_STRIDE; }

void binary_rotary_initialize(void) {
  for (uint32_t at = header_offset(0); at < header_offset(COORDINATE_SYSTEMS); at += DPRAM_WORD_BYTES)
    dpram_write(at, 0);
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++) begun[cs] = (struct begun){0};
  turn = 0;
  copying = false;
}

static void show_status(struct header* h, uint32_t status) {
  if (h->status != status) dpram_write(h->offset + DPRAM_ROTARY_STATUS, status);
  h->status = status;
}

static enum fault check_header(const struct header* h, uint32_t cs) {
  const uint32_t open_items = (dpram_bytes() - DPRAM_OPEN) / DPRAM_ITEM_BYTES;
  if (h->size < LEAST_SIZE || h->size % COMMAND_ITEMS != 0) return FAULT_SIZE;
  if (h->start + h->size > open_items) return FAULT_PLACE;
  if (h->host_index >= h->size || h->host_index % COMMAND_ITEMS != 0) return FAULT_INDEX;
  if (h->index >= h->size || h->index % COMMAND_ITEMS != 0) return FAULT_INDEX;
  if (h->host_index == h->index) return FAULT_NONE;
  return is_open() && rotary_buffers[cs].size != 0 ? FAULT_NONE : FAULT_NO_BUFFER;
}

/* What of a line is in the ring already, if nobody has changed anything since. */
static struct begun* resume(const struct header* h, uint32_t cs) {
  struct begun* b = &begun[cs];
  const uint32_t generation = rotary_buffers[cs].generation;
  if (b->count != 0 && b->line == h->index && b->size == h->size && b->start == h->start && b->generation == generation)
    return b;
  *b = (struct begun){.at = h->index, .line = h->index, .size = h->size, .start = h->start, .generation = generation};
  return b;
}

static word48_t read_command(const struct header* h, uint32_t index) {
  const uint32_t offset = dpram_open_offset(h->start + index);
  const word48_t first = dpram_read_item(offset) & HAL_WORD_MASK;
  return first << 24 | (dpram_read_item(offset + DPRAM_ITEM_BYTES) & HAL_WORD_MASK);
}

static bool is_end_of_buffer(word48_t command) {
  const uint32_t first = (uint32_t)(command >> 24);
  return first == END_OF_BUFFER || first == END_OF_BUFFER_SIGNED;
}

static enum step fail(struct header* h, uint32_t code) {
  show_status(h, DPRAM_ROTARY_ERROR | code);
  return STEP_STOP;
}

static enum step publish(struct header* h, uint32_t cs, struct begun* b) {
  const enum binary_fault fault = binary_judge_end(&b->judge);
  if (fault != BINARY_GOOD) return fail(h, fault);
  rotary_publish(cs, b->count);
  h->index = b->line = b->at;
  dpram_write(h->offset + DPRAM_ROTARY_PMAC_INDEX, h->index);
  b->count = 0;
  b->judge = (struct binary_judge){0};
  return STEP_DONE;
}

/* One command, or the end of a line. */
static enum step copy(struct header* h, uint32_t cs, struct begun* b) {
  if (b->at == h->host_index) return b->count != 0 ? publish(h, cs, b) : STEP_EMPTY;
  const word48_t command = read_command(h, b->at);
  const bool begins = (command & WORD_START_OF_LINE) != 0;
  if (is_end_of_buffer(command)) return STEP_EMPTY;
  if (begins && b->count != 0 && publish(h, cs, b) == STEP_STOP) return STEP_STOP;
  if (!begins && b->count == 0) return fail(h, BINARY_INCOMPLETE); /* of the line before */
  if (b->count >= rotary_buffers[cs].size) return fail(h, FAULT_LENGTH);
  if (b->count >= rotary_room(cs)) return STEP_BLOCKED;
  const enum binary_fault fault = binary_judge_word(&b->judge, command);
  if (fault != BINARY_GOOD) return fail(h, fault);
  rotary_put(cs, b->count++, command);
  b->at += COMMAND_ITEMS;
  if (b->at == h->size) b->at = 0;
  return STEP_DONE;
}

static void copy_lines(struct header* h, uint32_t cs) {
  struct begun* b = resume(h, cs);
  enum step step;
  do { step = copy(h, cs, b); } while (step == STEP_DONE && !time_is_over());
  if (step == STEP_STOP)
    b->count = 0;
  else
    show_status(h, step == STEP_BLOCKED ? DPRAM_ROTARY_BUSY : 0);
  is_active |= step == STEP_DONE || step == STEP_EMPTY;
}

static void look(uint32_t cs) {
  struct header h = {.offset = header_offset(cs)};
  const uint32_t enable = dpram_read(h.offset + DPRAM_ROTARY_ENABLE);
  if (enable != 0) h.status = dpram_read(h.offset + DPRAM_ROTARY_STATUS);
  if (enable == 0 || (h.status & DPRAM_ROTARY_ERROR) != 0) {
    begun[cs].count = 0;
    return;
  }
  h.host_index = dpram_read(h.offset + DPRAM_ROTARY_HOST_INDEX);
  h.index = dpram_read(h.offset + DPRAM_ROTARY_PMAC_INDEX);
  h.size = dpram_read(h.offset + DPRAM_ROTARY_SIZE);
  h.start = dpram_read(h.offset + DPRAM_ROTARY_START);
  const enum fault fault = enable == cs + 1u ? check_header(&h, cs) : FAULT_ENABLE;
  if (fault != FAULT_NONE) {
    begun[cs].count = 0;
    (void)fail(&h, fault);
  } else if (is_open()) {
    copy_lines(&h, cs);
  }
}

/* While nothing is open one header a pass is enough: what is there to be found are faults. */
static void pass(uint32_t cycles) {
  uint32_t left = is_open() ? COORDINATE_SYSTEMS : 1u;
  started = hal_cycles();
  length = cycles;
  is_active = false;
  do {
    look(turn);
    turn = (turn + 1u) % COORDINATE_SYSTEMS;
  } while (--left != 0 && !time_is_over());
}

void binary_rotary_pass(void) {
  if (is_foreground()) return;
  copying = true;
  pass(tasks_real_time_slice());
  copying = false;
  if (is_active) background_wake();
}

/* A program may set I45 while the background copies: that pass is still its own. */
void binary_rotary_real_time(void) {
  if (is_foreground() && !copying && tasks_real_time_is_periodic()) pass(tasks_real_time_slice() / FOREGROUND_PART);
}
