/* A slot's state is its first word and is written last. The other slot is outdated afterwards: a damaged image is then
 * an error, and never gives way to an older one unnoticed. When power goes between the two writes both are whole, and
 * the sequence tells which is newer. */
#include "firmware/image/flash_store.h"

#include "firmware/base/crc32.h"

enum { STROBED_WORDS = 1024 }; /* 0.4 ms of checking */

static const uint32_t* slot_words(uint32_t slot) { return hal_flash() + slot * FLASH_SLOT_WORDS; }
static uint32_t slot_state(uint32_t slot) { return slot_words(slot)[FLASH_WORD_STATE]; }
static bool state_is_known(uint32_t state) {
  return state == FLASH_BLANK || state == FLASH_WHOLE || state == FLASH_OUTDATED;
}

static uint32_t crc(uint32_t sum, const uint32_t* words, uint32_t count) {
  for (; count > STROBED_WORDS; words += STROBED_WORDS, count -= STROBED_WORDS) {
    sum = crc32_words(sum, words, STROBED_WORDS);
    hal_watchdog_strobe();
  }
  return crc32_words(sum, words, count);
}

/* The slot of the newest image that was whole when it was written; FLASH_SLOTS: there is none. */
static uint32_t newest(void) {
  const bool whole[FLASH_SLOTS] = {slot_state(0) == FLASH_WHOLE, slot_state(1) == FLASH_WHOLE};
  if (!whole[0] && !whole[1]) return FLASH_SLOTS;
  if (!whole[0] || !whole[1]) return whole[0] ? 0 : 1;
  return (int32_t)(slot_words(1)[FLASH_WORD_SEQUENCE] - slot_words(0)[FLASH_WORD_SEQUENCE]) > 0 ? 1 : 0;
}

flash_store_t flash_store_find(struct flash_image* image) {
  const uint32_t slot = newest();
  crc32_initialize();
  if (slot == FLASH_SLOTS)
    return state_is_known(slot_state(0)) && state_is_known(slot_state(1)) ? FLASH_STORE_EMPTY : FLASH_STORE_DAMAGED;
  const uint32_t* words = slot_words(slot);
  const uint32_t first = words[FLASH_WORD_FIRST_WORDS], second = words[FLASH_WORD_SECOND_WORDS];
  if (first > FLASH_FIRST_CAPACITY || second > FLASH_CAPACITY - first) return FLASH_STORE_DAMAGED;
  const uint32_t data = crc(CRC32_BEGIN, words + FLASH_WORD_DATA, first);
  if (words[FLASH_WORD_FIRST_CRC] != ~crc(data, words + FLASH_WORD_SEQUENCE, FLASH_WORD_DATA - FLASH_WORD_SEQUENCE))
    return FLASH_STORE_DAMAGED;
  *image = (struct flash_image){
      {words + FLASH_WORD_DATA, words + FLASH_WORD_DATA + first}, {first, second}, words[FLASH_WORD_SECOND_CRC]};
  return FLASH_STORE_FOUND;
}

bool flash_store_second_is_whole(const struct flash_image* image) {
  return image->second_crc == ~crc(CRC32_BEGIN, image->part[1], image->words[1]);
}

/* The image being written. */
static struct {
  uint32_t base; /* of its slot, in words of the store */
  uint32_t part, count;
  uint32_t words[FLASH_PARTS], sum[FLASH_PARTS];
} made;

static void write(uint32_t word, uint32_t value) { hal_flash_write(made.base + word, value); }

static void write_header(uint32_t word, uint32_t value) {
  write(word, value);
  made.sum[0] = crc32_add(made.sum[0], value);
}

/* It takes the place of a blank or outdated one. What is damaged stays until the new one counts: until then it is an
 * error. */
void flash_store_begin(void) {
  uint32_t kept = newest();
  if (kept == FLASH_SLOTS) kept = state_is_known(slot_state(0)) ? 1 : 0;
  made.base = (kept ^ 1u) * FLASH_SLOT_WORDS;
  made.part = made.count = 0;
  for (uint32_t part = 0; part < FLASH_PARTS; part++) {
    made.words[part] = 0;
    made.sum[part] = CRC32_BEGIN;
  }
  crc32_initialize();
  write(FLASH_WORD_STATE, FLASH_BLANK);
}

void flash_store_put(uint32_t word) {
  write(FLASH_WORD_DATA + made.count++, word);
  made.words[made.part]++;
  made.sum[made.part] = crc32_add(made.sum[made.part], word);
}

void flash_store_second_part(void) { made.part = 1; }

void flash_store_commit(void) {
  const uint32_t other = made.base ^ FLASH_SLOT_WORDS;
  write_header(FLASH_WORD_SEQUENCE, hal_flash()[other + FLASH_WORD_SEQUENCE] + 1u);
  write_header(FLASH_WORD_FIRST_WORDS, made.words[0]);
  write_header(FLASH_WORD_SECOND_WORDS, made.words[1]);
  write_header(FLASH_WORD_SECOND_CRC, ~made.sum[1]);
  write(FLASH_WORD_FIRST_CRC, ~made.sum[0]);
  write(FLASH_WORD_STATE, FLASH_WHOLE);
  hal_flash_write(other + FLASH_WORD_STATE, FLASH_OUTDATED);
}
