/* Fixed programs. A program that is opened again is turned to the top of the others: once an OPEN, not once a line. */
#include "firmware/buffers/fixed_programs.h"

#include <stdatomic.h>

#include "firmware/base/dimensions.h"
#include "firmware/buffers/program_structure.h"
#include "firmware/buffers/regions.h"
#include "firmware/buffers/user_memory.h"
#include "firmware/kernel/slice.h"
#include "firmware/kernel/watchdog.h"

static struct {
  struct fixed_program programs[FIXED_PROGRAMS_COUNT]; /* in memory order */
  uint32_t count;
  bool open; /* the last one */
  volatile uint32_t generation;
} fixed;

uint16_t fixed_program_links[USER_MEMORY_WORDS];

static void begin_change(void) {
  fixed.generation++;
  atomic_signal_fence(memory_order_seq_cst);
}

static void end_change(void) {
  atomic_signal_fence(memory_order_seq_cst);
  fixed.generation++;
}

void fixed_programs_initialize(void) {
  begin_change();
  fixed.count = 0;
  fixed.open = false;
  end_change();
}

uint32_t fixed_programs_generation(void) { return fixed.generation; }

void fixed_program_set_linked(const struct fixed_program* program) {
  fixed.programs[program - fixed.programs].linked = true;
}

uint32_t fixed_programs_count(void) { return fixed.count; }

const struct fixed_program* fixed_program_at(uint32_t index) { return &fixed.programs[index]; }

const struct fixed_program* fixed_program_find(enum fixed_kind kind, uint32_t number) {
  for (uint32_t i = 0; i < fixed.count; i++)
    if (fixed.programs[i].kind == kind && fixed.programs[i].number == number) return &fixed.programs[i];
  return 0;
}

word48_t fixed_program_word(const struct fixed_program* program, uint32_t offset) {
  return user_memory_read(program->base + offset);
}

uint32_t fixed_program_line(const struct fixed_program* program, uint32_t offset) {
  uint32_t at = offset;
  while (at < program->words) {
    const word48_t word = fixed_program_word(program, at);
    if (at != offset && (word & WORD_START_OF_LINE) != 0) break;
    const struct instruction in = word_decode(word);
    at += 1u + word_raw_count(&in);
    slice_pause();
  }
  return (at < program->words ? at : program->words) - offset;
}

static uint32_t top(void) {
  if (fixed.count == 0) return 0;
  const struct fixed_program* last = &fixed.programs[fixed.count - 1u];
  return last->base + last->words;
}

static void reverse(uint32_t first, uint32_t end) {
  for (; first + 1u < end; first++, end--) {
    const word48_t word = user_memory_read(first);
    const uint16_t link = fixed_program_links[first];
    user_memory_write(first, user_memory_read(end - 1u));
    user_memory_write(end - 1u, word);
    fixed_program_links[first] = fixed_program_links[end - 1u];
    fixed_program_links[end - 1u] = link;
  }
}

/* The words of program `index` go above all others: three reversals need no further memory. It takes as long as a SAVE
 * when memory is full, so the watchdog counter is reloaded. */
static void raise(uint32_t index) {
  const struct fixed_program raised = fixed.programs[index];
  const uint32_t end = top(), middle = raised.base + raised.words;
  if (index == fixed.count - 1u) return;
  begin_change();
  reverse(raised.base, middle);
  watchdog_reload();
  reverse(middle, end);
  watchdog_reload();
  reverse(raised.base, end);
  watchdog_reload();
  for (uint32_t i = index; i + 1u < fixed.count; i++) {
    fixed.programs[i] = fixed.programs[i + 1u];
    fixed.programs[i].base -= raised.words;
  }
  fixed.programs[fixed.count - 1u] = raised;
  fixed.programs[fixed.count - 1u].base = end - raised.words;
  end_change();
}

static bool has_room(enum fixed_kind kind) {
  uint32_t motion_programs = 0;
  for (uint32_t i = 0; i < fixed.count; i++) motion_programs += fixed.programs[i].kind == FIXED_PROG;
  return fixed.count < FIXED_PROGRAMS_COUNT && (kind != FIXED_PROG || motion_programs < FIXED_PROG_COUNT);
}

static void clear_links(uint32_t from, uint32_t words) {
  for (uint32_t i = 0; i < words; i++) fixed_program_links[from + i] = LINK_NONE;
}

static void enter(enum fixed_kind kind, uint32_t number, uint32_t words) {
  const uint32_t base = top();
  clear_links(base, words);
  begin_change();
  fixed.programs[fixed.count++] = (struct fixed_program){(uint16_t)kind, (uint16_t)number, base, words, false};
  end_change();
}

error_t fixed_program_open(enum fixed_kind kind, uint32_t number) {
  const struct fixed_program* there = fixed_program_find(kind, number);
  if (there != 0) {
    raise((uint32_t)(there - fixed.programs));
  } else {
    if (!has_room(kind)) return ERR_NO_ROOM;
    enter(kind, number, 0);
  }
  fixed.open = true;
  fixed.programs[fixed.count - 1u].linked = false;
  return ERR_NONE;
}

const struct fixed_program* fixed_program_opened(void) { return fixed.open ? &fixed.programs[fixed.count - 1u] : 0; }

error_t fixed_program_append(const word48_t* words, uint32_t count) {
  struct fixed_program* program = &fixed.programs[fixed.count - 1u];
  const uint32_t at = top();
  const error_t error = region_resize_fixed(at + count);
  if (error != ERR_NONE) return error;
  clear_links(at, count);
  for (uint32_t i = 0; i < count; i++) user_memory_write(at + i, i == 0 ? words[0] | WORD_START_OF_LINE : words[i]);
  program->words += count;
  return ERR_NONE;
}

static void shorten(uint32_t words) {
  struct fixed_program* program = &fixed.programs[fixed.count - 1u];
  (void)region_resize_fixed(program->base + words); /* that is less */
  program->words = words;
}

void fixed_program_drop_last(void) { shorten(fixed.programs[fixed.count - 1u].words - 1u); }

void fixed_program_clear(void) { shorten(0); }

void fixed_program_close(void) {
  begin_change(); /* its words have changed too */
  fixed.open = false;
  if (fixed.programs[fixed.count - 1u].words == 0) fixed.count--;
  end_change();
}

static void move_down(uint32_t from, uint32_t to, uint32_t words) {
  for (uint32_t i = 0; i < words; i++) {
    user_memory_write(to + i, user_memory_read(from + i));
    fixed_program_links[to + i] = fixed_program_links[from + i];
  }
}

/* What stays closes up. */
void fixed_programs_erase(uint32_t kinds) {
  uint32_t kept = 0, end = 0;
  begin_change();
  for (uint32_t i = 0; i < fixed.count; i++) {
    const struct fixed_program program = fixed.programs[i];
    if ((kinds >> program.kind & 1u) != 0) continue;
    move_down(program.base, end, program.words);
    watchdog_reload();
    fixed.programs[kept] = program;
    fixed.programs[kept++].base = end;
    end += program.words;
  }
  fixed.count = kept;
  (void)region_resize_fixed(end); /* that is less */
  end_change();
}

bool fixed_program_restore(enum fixed_kind kind, uint32_t number, uint32_t words) {
  static const uint32_t limits[FIXED_KINDS] = {FIXED_PROG_LIMIT + 1, FIXED_PLC_COUNT, COORDINATE_SYSTEMS,
                                               COORDINATE_SYSTEMS};
  if (number >= limits[kind] || words == 0 || words > USER_MEMORY_WORDS) return false;
  if (!has_room(kind) || fixed_program_find(kind, number) != 0) return false;
  if (region_resize_fixed(top() + words) != ERR_NONE) return false;
  enter(kind, number, words);
  return true;
}
