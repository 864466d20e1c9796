/* cos((k+1) d) = 2 cos(d) cos(k d) - cos((k-1) d), for a quarter of the circle; the rest is its mirror image. With 62
 * bits the error after 512 steps is below 2^-40. */
#include "firmware/motion/sine_table.h"

#include <stdbool.h>

#include "firmware/hal/hal.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/variables/words.h"

#define TABLE 0x003800u
#define ONE (1ull << 62)
#define COSINE_OF_STEP 4611664314954810277ull /* 2^62 cos(2 pi / 2048) */

enum { QUARTER = SINE_ENTRIES / 4, LARGEST = (1 << 23) - 1 };

/* 2^-62 to 2^-23, to the nearest. The word has no +1. */
static int32_t rounded(uint64_t value) {
  const uint64_t word = (value + (1ull << 38)) >> 39;
  return word > LARGEST ? LARGEST : (int32_t)word;
}

static void put(uint32_t entry, int32_t cosine, int32_t sine) {
  const uint32_t address = TABLE + entry % SINE_ENTRIES;
  *hal_x(address) = (uint32_t)cosine & HAL_WORD_MASK;
  *hal_y(address) = (uint32_t)sine & HAL_WORD_MASK;
}

/* -1 can be had, where +1 cannot. */
static int32_t negative(int32_t word) { return word == LARGEST ? -word - 1 : -word; }

static bool wanted; /* B */

void sine_table_later(void) { wanted = true; }

void sine_table_pass(void) {
  if (wanted) sine_table_initialize();
}

void sine_table_initialize(void) {
  wanted = false;
  int32_t cosine[QUARTER + 1];
  uint64_t before = ONE, present = COSINE_OF_STEP;
  cosine[0] = rounded(ONE);
  cosine[QUARTER] = 0;
  for (uint32_t k = 1; k < QUARTER; ++k) {
    cosine[k] = rounded(present);
    const uint64_t next = (fixed_multiply_high(present, COSINE_OF_STEP) << 3) - before; /* 2^124-64, times 2 */
    before = present;
    present = next;
  }
  for (uint32_t k = 0; k < QUARTER; ++k) {
    const int32_t c = cosine[k], s = cosine[QUARTER - k];
    put(k, c, s);
    put(k + QUARTER, negative(s), c);
    put(k + 2u * QUARTER, negative(c), negative(s));
    put(k + 3u * QUARTER, s, negative(c));
  }
}

uint32_t sine_table_address(uint32_t offset) {
  const uint32_t first = (TABLE + offset) & HAL_WORD_MASK & ~(SINE_ENTRIES - 1u);
  return word_exists(true, first) && word_exists(false, first + SINE_ENTRIES - 1u) ? first : TABLE;
}
