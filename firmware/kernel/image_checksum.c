#include "firmware/kernel/image_checksum.h"

#include "firmware/hal/hal.h"
#include "firmware/kernel/slice.h"

enum { PIECE = 64 }; /* words: 4 us at I52 = 7 */

static uint32_t sum, added; /* of so many words, until the next reset. B */

static void add(uint32_t most) {
  uint32_t count;
  const uint32_t* image = hal_image(&count);
  const uint32_t end = count - added < most ? count : added + most;
  uint32_t s = sum;
  for (uint32_t i = added; i < end; ++i) s += image[i];
  sum = s;
  added = end;
}

void image_checksum_pass(void) {
  if (slice_hurry == 0u) add(PIECE);
}

uint32_t image_checksum(void) {
  add(UINT32_MAX);
  return sum & HAL_WORD_MASK;
}
