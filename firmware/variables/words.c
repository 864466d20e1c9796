/* One register of the on-chip page is answered here: X:$FFFF8C, half the CPU cycles between two phase interrupts, which
 * clients divide task durations by. The real CPU counts it in a timer. */
#include "firmware/variables/words.h"

#include "firmware/hal/hal.h"
#include "firmware/variables/phase_period.h"
#include "rtl/regs/brick_regs.h"

#define PHASE_PERIOD 0xFFFF8Cu

bool word_exists(bool x, uint32_t address) {
  if (address - MAIN_MEMORY_BASE < MAIN_MEMORY_SIZE) return true;
  if (address - DPRAM_BASE < DPRAM_SIZE) return hal_strap(HAL_STRAP_DPRAM_WORDS) > 2u * (address - DPRAM_BASE);
  if (address - GATE_ICS_BASE < GATE_ICS_SIZE) return true;
  return x && address >= BOARD_LATCHES_BASE && address - LATCHES_BASE < LATCHES_SIZE;
}

bool word_is_plain(uint32_t address) {
  uint32_t x, y;
  if (address - MAIN_MEMORY_BASE >= MAIN_MEMORY_SIZE) return false;
  return address >= word_hooks.end || !word_hooks.read(address, &x, &y);
}

static volatile uint32_t* place(bool x, uint32_t address) { return x ? hal_x(address) : hal_y(address); }

void word_read_long(uint32_t address, uint32_t* x, uint32_t* y) {
  const bool x_exists = word_exists(true, address), y_exists = word_exists(false, address);
  const uint32_t state = hal_mask_servo(); /* the servo task moves positions of two words */
  *x = x_exists ? *hal_x(address) : 0u;
  *y = y_exists ? *hal_y(address) : 0u;
  hal_unmask(state);
  if (address == PHASE_PERIOD) *x = phase_period() / 2u;
  if (address < word_hooks.end) (void)word_hooks.read(address, x, y);
  *x &= HAL_WORD_MASK;
  *y &= HAL_WORD_MASK;
}

uint32_t word_read(bool x, uint32_t address) {
  if (x && address == PHASE_PERIOD) return phase_period() / 2u;
  if (!word_exists(x, address)) return 0;
  uint32_t halves[2] = {0, 0};
  halves[x] = *place(x, address);
  if (address < word_hooks.end) word_hooks.read(address, &halves[1], &halves[0]);
  return halves[x] & HAL_WORD_MASK;
}

/* Whether the write is for the word itself: not taken by who makes it, and there is one. */
static bool is_stored(bool x, uint32_t address, uint32_t mask, uint32_t bits) {
  if (address < word_hooks.end && word_hooks.write(x, address, mask, bits & mask)) return false;
  return word_exists(x, address);
}

void word_write_part(bool x, uint32_t address, uint32_t mask, uint32_t bits) {
  if (!is_stored(x, address, mask, bits)) return;
  volatile uint32_t* word = place(x, address);
  if (mask == HAL_WORD_MASK) { /* nothing to keep: a register is not read */
    *word = bits & HAL_WORD_MASK;
    return;
  }
  const uint32_t state = hal_mask_servo();
  *word = (*word & ~mask) | (bits & mask);
  hal_unmask(state);
}

void word_write(bool x, uint32_t address, uint32_t value) { word_write_part(x, address, HAL_WORD_MASK, value); }

void word_write_long(uint32_t address, uint32_t x, uint32_t y) {
  if (address < word_hooks.end && word_hooks.write_long(address, x & HAL_WORD_MASK, y & HAL_WORD_MASK)) return;
  const bool stores_x = is_stored(true, address, HAL_WORD_MASK, x);
  const bool stores_y = is_stored(false, address, HAL_WORD_MASK, y);
  const uint32_t state = hal_mask_servo();
  if (stores_x) *hal_x(address) = x & HAL_WORD_MASK;
  if (stores_y) *hal_y(address) = y & HAL_WORD_MASK;
  hal_unmask(state);
}
