/* What SAVE keeps, as words of an image of the flash store (docs/save.md). All of it are runs: a word with the first
 * number, a bit and a count, then one word or, with the bit, two of each number of the run. A section ends with a word
 * 0. A CRC says that nothing has changed, not who wrote it: each number is checked again where it becomes a place. */
#include "firmware/image/saved_data.h"

#include "firmware/base/dimensions.h"
#include "firmware/base/mathematics.h"
#include "firmware/base/memory_map.h"
#include "firmware/buffers/compensation_tables.h"
#include "firmware/buffers/fixed_programs.h"
#include "firmware/buffers/program_password.h"
#include "firmware/buffers/user_memory.h"
#include "firmware/hal/gate_ic.h"
#include "firmware/hal/hal.h"
#include "firmware/image/flash_store.h"
#include "firmware/kernel/watchdog.h"
#include "firmware/motion/axis_definition.h"
#include "firmware/variables/i_variables.h"

enum { RUN_FIRST_BIT = 16, RUN_DOUBLE = 0x8000, RUN_COUNT = 0x7FFF };
enum { IC_WORDS = 2 }; /* begin the first part: ICs at the last re-initialisation, ICs at SAVE */
enum { USER_FIRST = MEMORY_M_DEFINITIONS, USER_END = MEMORY_BUFFERS }; /* M definitions, P, Q */
enum { AXIS_WORDS = 1 + 2 * (AXIS_COUNT + 1), AXIS_KINEMATIC = 0x100 };
enum { TABLE_SPAN, TABLE_MOTORS, TABLE_HEAD_WORDS, TABLE_TARGET_BIT = 8, TABLE_OF_DESIRED = 0x10000 };
enum { PASSWORD_WORDS = PASSWORD_LENGTH / 4 };
enum { EARLY_VARIABLES = I_MOTOR_BLOCK + I_BASE_TABLE - I_BASE_MACRO, RESTORED_AT_ONCE = 256 };

/* Fits whatever there is to keep: where every second number is zero and needs no word, the others need one for their
 * run. */
enum {
  MOST_SECTION_ENDS = 11,
  MOST_WORDS = IC_WORDS + 3 * VARIABLE_COUNT + 1 + 2 * (USER_END - USER_FIRST) + MOTORS * (1 + AXIS_WORDS) + 1 +
               FIXED_PROGRAMS_COUNT + 2 * USER_MEMORY_WORDS + COMPENSATION_KINDS * MOTORS * (1 + TABLE_HEAD_WORDS) + 1 +
               PASSWORD_WORDS + MOST_SECTION_ENDS
};
_Static_assert((uint32_t)MOST_WORDS <= (uint32_t)FLASH_CAPACITY, "an image must fit a slot");
_Static_assert(IC_WORDS + 3 * EARLY_VARIABLES + 1 <= (uint32_t)FLASH_FIRST_CAPACITY, "so must its first part");
_Static_assert(USER_END - USER_FIRST <= 0x7FFF && USER_MEMORY_WORDS <= 0x7FFF, "a run counts to 32767");

union double_words {
  double value;
  uint32_t word[2];
};

/* SAVE ------------------------------------------------------------------------------------------------------------- */

/* It is one background pass, longer than a small I40 allows. */
static void keep_alive(uint32_t step) {
  if (step % 64u == 0u) watchdog_reload();
}

static void put_run(uint32_t first, uint32_t count, bool two_words) {
  flash_store_put(first << RUN_FIRST_BIT | (two_words ? RUN_DOUBLE : 0u) | count);
}

static void put_double(double number) {
  const union double_words words = {.value = number};
  flash_store_put(words.word[0]);
  flash_store_put(words.word[1]);
}

static void put_end(void) { flash_store_put(0); }

static i_kept_t kept_in_part(uint32_t number, bool early) {
  return i_variable_is_early(number) == early ? i_variable_kept(number) : I_NOT_KEPT;
}

static void put_i_variables(bool early) {
  for (uint32_t number = 0, end; number < VARIABLE_COUNT; number = end) {
    const i_kept_t kept = kept_in_part(number, early);
    for (end = number + 1u; end < VARIABLE_COUNT && kept_in_part(end, early) == kept; end++) keep_alive(end);
    if (kept == I_NOT_KEPT) continue;
    put_run(number, end - number, kept == I_KEPT_FLOAT);
    for (uint32_t each = number; each < end; each++) {
      keep_alive(each);
      if (kept == I_KEPT_FLOAT)
        put_double(i_variable_read(each));
      else
        flash_store_put((uint32_t)i_integer(each));
    }
  }
  put_end();
}

/* Both halves of a number at once: the real-time task writes P, Q and M too. */
static word48_t user_word(uint32_t address) {
  const uint32_t state = hal_mask_real_time();
  const uint32_t x = *hal_x(address) & HAL_WORD_MASK, y = *hal_y(address) & HAL_WORD_MASK;
  hal_unmask(state);
  return (word48_t)x << 24 | y;
}

static void put_word48(word48_t word) {
  flash_store_put((uint32_t)(word >> 24) & HAL_WORD_MASK);
  flash_store_put((uint32_t)word & HAL_WORD_MASK);
}

static void put_user_memory(void) {
  for (uint32_t address = USER_FIRST, end; address < USER_END; address = end) {
    for (end = address; end < USER_END && user_word(end) != 0; end++) keep_alive(end);
    if (end == address) {
      keep_alive(end++);
      continue;
    }
    put_run(address - USER_FIRST, end - address, true);
    for (uint32_t each = address; each < end; each++) {
      keep_alive(each);
      put_word48(user_word(each));
    }
  }
  put_end();
}

static void put_axis_definitions(void) {
  for (uint32_t motor = 0; motor < MOTORS; motor++) {
    const struct axis_definition* axis = &axis_definitions[motor];
    if (!axis->assigned) continue;
    put_run(motor, AXIS_WORDS, false);
    flash_store_put(axis->cs | (axis->kinematic ? AXIS_KINEMATIC : 0u));
    for (uint32_t i = 0; i < AXIS_COUNT; i++) put_double(axis->scale[i]);
    put_double(axis->offset);
  }
  put_end();
}

static void put_programs(enum fixed_kind kind) {
  for (uint32_t index = 0; index < fixed_programs_count(); index++) {
    const struct fixed_program* program = fixed_program_at(index);
    if (program->kind != kind || program->words == 0u) continue; /* open and empty */
    put_run(program->number, program->words, true);
    for (uint32_t offset = 0; offset < program->words; offset++) {
      keep_alive(offset);
      put_word48(fixed_program_word(program, offset));
    }
  }
  put_end();
}

/* A run without words: its first number is the size. */
static void put_user_buffer(void) {
  if (region_user_words() != 0u) put_run(region_user_words(), 0, false);
  put_end();
}

/* A kind's tables stand in memory from the last motor to the first. */
static void put_tables(enum region_kind kind) {
  for (uint32_t motor = MOTORS; motor-- > 0u;) {
    const struct compensation_table* table = compensation_table(kind, motor);
    if (table == 0) continue;
    const uint32_t entries = region_words(kind, motor);
    put_run(kind * MOTORS + motor, TABLE_HEAD_WORDS + entries, false);
    flash_store_put(table->span);
    flash_store_put(table->source | (uint32_t)table->target << TABLE_TARGET_BIT |
                    (table->of_desired ? TABLE_OF_DESIRED : 0u));
    for (uint32_t i = 0; i < entries; i++) {
      keep_alive(i);
      flash_store_put((uint32_t)compensation_entry(kind, motor, i));
    }
  }
}

static void put_password(void) {
  const char* text;
  const uint32_t length = program_password(&text), words = (length + 3u) / 4u;
  if (length != 0u) put_run(length, words, false);
  for (uint32_t i = 0; i < words; i++) {
    uint32_t word = 0;
    for (uint32_t byte = 0; byte < 4u && 4u * i + byte < length; byte++)
      word |= (uint32_t)(uint8_t)text[4u * i + byte] << 8u * byte;
    flash_store_put(word);
  }
  put_end();
}

void saved_data_write(uint32_t initial_ics) {
  flash_store_begin();
  flash_store_put(initial_ics);
  flash_store_put(gate_ic_found());
  put_i_variables(true);
  flash_store_second_part();
  put_i_variables(false);
  put_user_memory();
  put_axis_definitions();
  for (uint32_t kind = 0; kind < FIXED_KINDS; kind++) put_programs((enum fixed_kind)kind);
  put_password();
  put_user_buffer();
  for (uint32_t kind = 0; kind < COMPENSATION_KINDS; kind++) put_tables((enum region_kind)kind);
  put_end();
  flash_store_commit();
}

/* Start-up --------------------------------------------------------------------------------------------------------- */

static struct flash_image image;

/* What is being read. Never beyond `end`: a part without the end of a section ends there too. */
struct cursor {
  const uint32_t *at, *end;
};

struct run {
  uint32_t first, count;
  bool two_words;
  const uint32_t* words;
};

/* The next run of the section; false: it ends here, and the next section begins. */
static bool next_run(struct cursor* c, struct run* run) {
  if (c->at == c->end) return false;
  const uint32_t head = *c->at++;
  if (head == 0u) return false;
  *run = (struct run){head >> RUN_FIRST_BIT, head & RUN_COUNT, (head & RUN_DOUBLE) != 0u, c->at};
  const uint32_t left = (uint32_t)(c->end - c->at), words = run->two_words ? 2u * run->count : run->count;
  if (words > left) {
    c->at = c->end;
    return false;
  }
  c->at += words;
  return true;
}

static double double_of(const uint32_t* words) {
  const union double_words number = {.word = {words[0], words[1]}};
  return number.value;
}

static void restore_i_variables(struct cursor* c, bool early) {
  struct run run;
  uint32_t restored = 0;
  while (next_run(c, &run)) {
    for (uint32_t i = 0; i < run.count; i++) {
      const uint32_t number = run.first + i;
      if (restored++ % RESTORED_AT_ONCE == 0u) hal_watchdog_strobe();
      if (i_variable_is_early(number) != early) continue;
      if (run.two_words)
        i_variable_restore_float(number, double_of(run.words + 2u * i));
      else
        i_variable_restore_integer(number, (int32_t)run.words[i]);
    }
  }
}

saved_t saved_data_restore_early(uint32_t* initial_ics) {
  const flash_store_t found = flash_store_find(&image);
  if (found == FLASH_STORE_EMPTY) return SAVED_NONE;
  if (found == FLASH_STORE_DAMAGED || image.words[0] < IC_WORDS) return SAVED_DAMAGED;
  struct cursor c = {image.part[0] + IC_WORDS, image.part[0] + image.words[0]};
  *initial_ics = image.part[0][0];
  i_variable_begin_restore(image.part[0][1]);
  restore_i_variables(&c, true);
  return SAVED_GOOD;
}

bool saved_data_rest_is_whole(void) { return flash_store_second_is_whole(&image); }

static void restore_user_memory(struct cursor* c) {
  struct run run;
  while (next_run(c, &run)) {
    if (!run.two_words || run.first + run.count > USER_END - USER_FIRST) continue;
    for (uint32_t i = 0; i < run.count; i++) {
      *hal_x(USER_FIRST + run.first + i) = run.words[2u * i];
      *hal_y(USER_FIRST + run.first + i) = run.words[2u * i + 1u];
    }
  }
}

static void restore_axis_definition(const struct run* run) {
  struct axis_definition axis = {.assigned = true, .kinematic = (run->words[0] & AXIS_KINEMATIC) != 0u};
  axis.cs = run->words[0] & ~(uint32_t)AXIS_KINEMATIC;
  bool finite = true;
  for (uint32_t i = 0; i <= AXIS_COUNT; i++) {
    const double number = double_of(run->words + 1u + 2u * i);
    finite = finite && math_is_finite(number);
    if (i < AXIS_COUNT)
      axis.scale[i] = number;
    else
      axis.offset = number;
  }
  if (axis.cs < COORDINATE_SYSTEMS && finite) axis_define(run->first, &axis);
}

static void restore_axis_definitions(struct cursor* c) {
  struct run run;
  while (next_run(c, &run))
    if (!run.two_words && run.count == AXIS_WORDS && run.first < MOTORS) restore_axis_definition(&run);
}

static void restore_programs(struct cursor* c, enum fixed_kind kind) {
  struct run run;
  while (next_run(c, &run)) {
    if (!run.two_words || !fixed_program_restore(kind, run.first, run.count)) continue;
    const uint32_t base = fixed_program_at(fixed_programs_count() - 1u)->base;
    for (uint32_t i = 0; i < run.count; i++)
      user_memory_write(base + i, (word48_t)run.words[2u * i] << 24 | run.words[2u * i + 1u]);
  }
}

static void restore_user_buffer(struct cursor* c) {
  struct run run;
  while (next_run(c, &run)) (void)region_restore_user(run.first);
}

static void restore_table(const struct run* run) {
  const uint32_t* words = run->words + TABLE_HEAD_WORDS;
  const uint32_t entries = run->count - TABLE_HEAD_WORDS, head = run->words[TABLE_MOTORS];
  const enum region_kind kind = (enum region_kind)(run->first / MOTORS);
  const struct compensation_table table = {.span = run->words[TABLE_SPAN],
                                           .source = (uint8_t)(head % MOTORS),
                                           .target = (uint8_t)((head >> TABLE_TARGET_BIT) % MOTORS),
                                           .of_desired = (head & TABLE_OF_DESIRED) != 0u};
  if (compensation_table_define(kind, run->first % MOTORS, entries, &table) != ERR_NONE) return;
  for (uint32_t i = 0; i < entries; i++) compensation_set_entry(kind, run->first % MOTORS, i, (int32_t)words[i]);
}

static void restore_tables(struct cursor* c) {
  struct run run;
  while (next_run(c, &run))
    if (!run.two_words && run.first < COMPENSATION_KINDS * MOTORS && run.count > TABLE_HEAD_WORDS) restore_table(&run);
}

static void restore_password(struct cursor* c) {
  char text[PASSWORD_LENGTH];
  struct run run;
  while (next_run(c, &run)) {
    if (run.two_words || run.first > PASSWORD_LENGTH || run.first > 4u * run.count) continue;
    for (uint32_t i = 0; i < run.first; i++) text[i] = (char)(run.words[i / 4u] >> 8u * (i % 4u));
    program_password_restore(text, run.first);
  }
}

void saved_data_restore_rest(void) {
  struct cursor c = {image.part[1], image.part[1] + image.words[1]};
  restore_i_variables(&c, false);
  restore_user_memory(&c);
  hal_watchdog_strobe();
  restore_axis_definitions(&c);
  for (uint32_t kind = 0; kind < FIXED_KINDS; kind++) restore_programs(&c, (enum fixed_kind)kind);
  restore_password(&c);
  restore_user_buffer(&c);
  restore_tables(&c);
}
