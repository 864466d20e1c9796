/* What SAVE keeps in the flash store: I-variables, P, Q and M definitions, without the zeros. Layout in 32-bit words: mark, checksum,
 * count, ICs at the last re-initialisation, then `count` words: (number, low, high) of I-variables, a separator, and
 * (address, X, Y) of user memory. Start-up restores over the factory defaults. */
#include "firmware/hal/hal.h"
#include "firmware/kernel/internal.h"
#include "firmware/variables/variables.h"

#define MARK 0x42524B31u
#define SEPARATOR 0xFFFFFFFFu
enum { WORD_MARK, WORD_CHECKSUM, WORD_COUNT, WORD_ICS, WORD_DATA };
enum { USER_FIRST = 0x4000, USER_END = 0xA000 }; /* M definitions, P, Q */

union double_words {
  double value;
  uint32_t word[2];
};

static uint32_t checksum(const uint32_t* data, uint32_t count) {
  uint32_t sum = MARK;
  for (uint32_t i = 0; i < count; ++i) sum = ((sum << 1) | (sum >> 31)) + data[i];
  return sum;
}

void saved_data_write(uint32_t ics) {
  uint32_t* flash = hal_flash();
  uint32_t* data = flash + WORD_DATA;
  uint32_t count = 0;
  for (uint32_t number = 0; number < VARIABLE_COUNT; ++number) {
    const union double_words value = {.value = i_variable_stored(number)};
    if ((value.word[0] | value.word[1]) == 0u) continue;
    data[count++] = number;
    data[count++] = value.word[0];
    data[count++] = value.word[1];
  }
  data[count++] = SEPARATOR;
  for (uint32_t address = USER_FIRST; address < USER_END; ++address) {
    const uint32_t x = *hal_x(address) & HAL_WORD_MASK;
    const uint32_t y = *hal_y(address) & HAL_WORD_MASK;
    if ((x | y) == 0u) continue;
    data[count++] = address;
    data[count++] = x;
    data[count++] = y;
  }
  data[count++] = SEPARATOR;
  flash[WORD_MARK] = MARK;
  flash[WORD_COUNT] = count;
  flash[WORD_ICS] = ics;
  flash[WORD_CHECKSUM] = checksum(flash + WORD_COUNT, count + 2u);
}

saved_t saved_data_restore(uint32_t* ics) {
  const uint32_t* flash = hal_flash();
  const uint32_t* data = flash + WORD_DATA;
  if (flash[WORD_MARK] == 0xFFFFFFFFu) return SAVED_NONE;
  const uint32_t count = flash[WORD_COUNT];
  if (flash[WORD_MARK] != MARK || count > HAL_FLASH_BYTES / 4u - WORD_DATA) return SAVED_DAMAGED;
  if (flash[WORD_CHECKSUM] != checksum(flash + WORD_COUNT, count + 2u)) return SAVED_DAMAGED;
  *ics = flash[WORD_ICS];
  i_variable_clear();
  for (; *data != SEPARATOR; data += 3) {
    union double_words value;
    value.word[0] = data[1];
    value.word[1] = data[2];
    i_variable_restore(data[0], value.value);
  }
  for (++data; *data != SEPARATOR; data += 3) {
    *hal_x(data[0]) = data[1];
    *hal_y(data[0]) = data[2];
  }
  return SAVED_GOOD;
}
