/* The standard user memory: 26,624 long words of 48 bits at $00A000 (firmware:1.10). Buffers count in these words. */
#ifndef FIRMWARE_BUFFERS_USER_MEMORY_H
#define FIRMWARE_BUFFERS_USER_MEMORY_H

#include "firmware/base/memory_map.h"
#include "firmware/hal/hal.h"
#include "firmware/language/word.h"

enum { USER_MEMORY_WORDS = MEMORY_BUFFERS_END - MEMORY_BUFFERS };

static inline word48_t user_memory_read(uint32_t offset) {
  uint32_t address = MEMORY_BUFFERS + offset;
  return ((word48_t)(*hal_x(address) & HAL_WORD_MASK) << 24) | (*hal_y(address) & HAL_WORD_MASK);
}

static inline void user_memory_write(uint32_t offset, word48_t word) {
  uint32_t address = MEMORY_BUFFERS + offset;
  *hal_x(address) = (uint32_t)(word >> 24) & HAL_WORD_MASK;
  *hal_y(address) = (uint32_t)word & HAL_WORD_MASK;
}

#endif
