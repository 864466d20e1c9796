/* Words of the dual-ported RAM by the host's byte offsets (rtl/regs/dpram_map.h). The host may write any of them at any
 * time: what is read is looked at once and checked where it enters. Words beyond the fitted size read 0. */
#ifndef FIRMWARE_BASE_DPRAM_H
#define FIRMWARE_BASE_DPRAM_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/hal/hal.h"
#include "rtl/regs/brick_regs.h"
#include "rtl/regs/dpram_map.h"

enum { DPRAM_WORD_MASK = 0xFFFF };

static inline volatile uint32_t* dpram_word(uint32_t offset) {
  const uint32_t address = DPRAM_BASE + offset / DPRAM_ITEM_BYTES;
  return (offset & DPRAM_WORD_BYTES) != 0u ? hal_x(address) : hal_y(address);
}

static inline uint32_t dpram_read(uint32_t offset) { return *dpram_word(offset) & DPRAM_WORD_MASK; }
static inline void dpram_write(uint32_t offset, uint32_t word) { *dpram_word(offset) = word & DPRAM_WORD_MASK; }

/* An item of 32 bits: two accesses, between which the host may have one. */
static inline uint32_t dpram_read_item(uint32_t offset) {
  const uint32_t low = dpram_read(offset);
  return low | dpram_read(offset + DPRAM_WORD_BYTES) << 16;
}

static inline void dpram_write_item(uint32_t offset, uint32_t item) {
  dpram_write(offset, item);
  dpram_write(offset + DPRAM_WORD_BYTES, item >> 16);
}

static inline uint32_t dpram_bytes(void) { return hal_strap(HAL_STRAP_DPRAM_WORDS) * DPRAM_WORD_BYTES; }
/* Where a buffer begins whose header says `start`: PMAC addresses behind the fixed part. */
static inline uint32_t dpram_open_offset(uint32_t start) { return DPRAM_OPEN + start * DPRAM_ITEM_BYTES; }

#endif
