/* A byte a step, by a table of 1 KiB. Bit by bit, the 4,096 words that the first part of an image has at most would be
 * checked in 7 ms of the 25 that the start-up has until the clocks run (docs/save.md). */
#include "firmware/base/crc32.h"

enum { BYTES = 256, BYTE_MASK = 0xFF };
#define POLYNOMIAL 0xEDB88320u /* low bit first */

static uint32_t table[BYTES]; /* background task */

void crc32_initialize(void) {
  for (uint32_t byte = 0; byte < BYTES; byte++) {
    uint32_t sum = byte;
    for (uint32_t bit = 0; bit < 8u; bit++) sum = (sum >> 1) ^ ((sum & 1u) != 0u ? POLYNOMIAL : 0u);
    table[byte] = sum;
  }
}

static inline uint32_t add(uint32_t sum, uint32_t word) {
  sum ^= word;
  sum = (sum >> 8) ^ table[sum & BYTE_MASK];
  sum = (sum >> 8) ^ table[sum & BYTE_MASK];
  sum = (sum >> 8) ^ table[sum & BYTE_MASK];
  return (sum >> 8) ^ table[sum & BYTE_MASK];
}

uint32_t crc32_add(uint32_t sum, uint32_t word) { return add(sum, word); }

uint32_t crc32_words(uint32_t sum, const uint32_t* words, uint32_t count) {
  for (uint32_t i = 0; i < count; i++) sum = add(sum, words[i]);
  return sum;
}
