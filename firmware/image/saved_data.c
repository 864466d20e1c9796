/* What SAVE keeps in the flash store: I-variables, P, Q and M definitions, without the zeros, axis definitions and the
 * fixed programs. Layout in 32-bit words: mark, checksum, count, ICs at the last re-initialisation, ICs at SAVE, then
 * `count` words: (number, value low, value high, integer) of I-variables, a separator, (address, X, Y) of user memory,
 * a separator, (motor, words of its definition) of axes, a separator, (kind and number, count, (X, Y) of each word) of
 * programs, a separator. A checksum says that nothing has changed, not who wrote it: the numbers are checked again
 * where they become places. */
#include "firmware/image/saved_data.h"

#include <stdbool.h>

#include "firmware/base/dimensions.h"
#include "firmware/base/memory_map.h"
#include "firmware/buffers/fixed_programs.h"
#include "firmware/buffers/user_memory.h"
#include "firmware/hal/gate_ic.h"
#include "firmware/hal/hal.h"
#include "firmware/kernel/watchdog.h"
#include "firmware/motion/axis_definition.h"
#include "firmware/variables/i_variables.h"

#define MARK 0x42524B33u
#define SEPARATOR 0xFFFFFFFFu
enum { WORD_MARK, WORD_CHECKSUM, WORD_COUNT, WORD_INITIAL_ICS, WORD_SAVED_ICS, WORD_DATA };
enum { AXIS_DEFINITION_WORDS = sizeof(struct axis_definition) / 4 };
enum { USER_FIRST = MEMORY_M_DEFINITIONS, USER_END = MEMORY_BUFFERS }; /* M definitions, P, Q */

union double_words {
  double value;
  uint32_t word[2];
};

/* The record at `at` and where the data end. Never beyond them: a store without a separator ends there too. */
static const uint32_t *user_words, *data_end;

static bool has_record(const uint32_t* at, uint32_t words) {
  return at < data_end && (uint32_t)(data_end - at) >= words && *at != SEPARATOR;
}

static uint32_t checksum(const uint32_t* data, uint32_t count) {
  uint32_t sum = MARK;
  for (uint32_t i = 0; i < count; ++i) sum = ((sum << 1) | (sum >> 31)) + data[i];
  return sum;
}

enum { KIND_BIT = 16 }; /* of a program's kind, above its number */

static uint32_t checked_words(uint32_t count) { return count + WORD_DATA - WORD_COUNT; }

/* SAVE is one background pass, longer than a small I40 allows. */
static void keep_alive(uint32_t step) {
  if (step % 64u == 0u) watchdog_reload();
}

static uint32_t write_programs(uint32_t* data, uint32_t count) {
  for (uint32_t index = 0; index < fixed_programs_count(); ++index) {
    const struct fixed_program* program = fixed_program_at(index);
    if (program->words == 0u) continue; /* open and empty */
    data[count++] = (uint32_t)program->kind << KIND_BIT | program->number;
    data[count++] = program->words;
    for (uint32_t offset = 0; offset < program->words; ++offset) {
      keep_alive(offset);
      const word48_t word = fixed_program_word(program, offset);
      data[count++] = (uint32_t)(word >> 24) & HAL_WORD_MASK;
      data[count++] = (uint32_t)word & HAL_WORD_MASK;
    }
  }
  data[count++] = SEPARATOR;
  return count;
}

static void restore_programs(const uint32_t* data) {
  while (has_record(data, 2)) {
    const uint32_t kind = data[0] >> KIND_BIT, number = data[0] & 0xFFFFu, words = data[1];
    data += 2;
    if (words > (uint32_t)(data_end - data) / 2u) return;
    if (!fixed_program_restore((enum fixed_kind)kind, number, words)) return; /* not written by this firmware */
    const uint32_t base = fixed_program_at(fixed_programs_count() - 1u)->base;
    for (uint32_t offset = 0; offset < words; ++offset, data += 2)
      user_memory_write(base + offset, (word48_t)data[0] << 24 | data[1]);
  }
}

void saved_data_write(uint32_t initial_ics) {
  uint32_t* flash = hal_flash();
  uint32_t* data = flash + WORD_DATA;
  uint32_t count = 0;
  for (uint32_t number = 0; number < VARIABLE_COUNT; ++number) {
    struct i_saved saved;
    keep_alive(number);
    if (!i_variable_save(number, &saved)) continue;
    const union double_words value = {.value = saved.value};
    data[count++] = number;
    data[count++] = value.word[0];
    data[count++] = value.word[1];
    data[count++] = (uint32_t)saved.integer;
  }
  data[count++] = SEPARATOR;
  for (uint32_t address = USER_FIRST; address < USER_END; ++address) {
    keep_alive(address);
    const uint32_t x = *hal_x(address) & HAL_WORD_MASK;
    const uint32_t y = *hal_y(address) & HAL_WORD_MASK;
    if ((x | y) == 0u) continue;
    data[count++] = address;
    data[count++] = x;
    data[count++] = y;
  }
  data[count++] = SEPARATOR;
  for (uint32_t motor = 0; motor < MOTORS; ++motor) {
    if (!axis_definitions[motor].assigned) continue;
    data[count++] = motor;
    __builtin_memcpy(&data[count], &axis_definitions[motor], sizeof axis_definitions[motor]);
    count += AXIS_DEFINITION_WORDS;
  }
  data[count++] = SEPARATOR;
  count = write_programs(data, count);
  flash[WORD_MARK] = MARK;
  flash[WORD_COUNT] = count;
  flash[WORD_INITIAL_ICS] = initial_ics;
  flash[WORD_SAVED_ICS] = gate_ic_found();
  flash[WORD_CHECKSUM] = checksum(flash + WORD_COUNT, checked_words(count));
}

saved_t saved_data_restore_variables(uint32_t* initial_ics) {
  const uint32_t* flash = hal_flash();
  const uint32_t* data = flash + WORD_DATA;
  user_words = 0;
  if (flash[WORD_MARK] == 0xFFFFFFFFu) return SAVED_NONE;
  const uint32_t count = flash[WORD_COUNT];
  if (flash[WORD_MARK] != MARK || count > HAL_FLASH_BYTES / 4u - WORD_DATA) return SAVED_DAMAGED;
  if (flash[WORD_CHECKSUM] != checksum(flash + WORD_COUNT, checked_words(count))) return SAVED_DAMAGED;
  *initial_ics = flash[WORD_INITIAL_ICS];
  data_end = data + count;
  i_variable_begin_restore(flash[WORD_SAVED_ICS]);
  for (; has_record(data, 4); data += 4) {
    union double_words value;
    value.word[0] = data[1];
    value.word[1] = data[2];
    const struct i_saved saved = {value.value, (int32_t)data[3]};
    i_variable_restore(data[0], &saved);
  }
  user_words = data + 1;
  return SAVED_GOOD;
}

void saved_data_restore_user_memory(void) {
  if (user_words == 0) return;
  const uint32_t* data = user_words;
  for (; has_record(data, 3); data += 3) {
    if (data[0] - USER_FIRST >= USER_END - USER_FIRST) continue;
    *hal_x(data[0]) = data[1];
    *hal_y(data[0]) = data[2];
  }
  for (++data; has_record(data, 1 + AXIS_DEFINITION_WORDS); data += 1 + AXIS_DEFINITION_WORDS)
    if (data[0] < MOTORS) __builtin_memcpy(&axis_definitions[data[0]], data + 1, sizeof axis_definitions[0]);
  restore_programs(data + 1);
}
