/* One register of the on-chip page is answered here: X:$FFFF8C, half the CPU cycles between two phase interrupts, which
 * clients divide task durations by. The real CPU counts it in a timer. */
#include "firmware/variables/words.h"

#include "firmware/hal/hal.h"
#include "firmware/variables/phase_period.h"
#include "rtl/regs/brick_regs.h"

#define MAIN_MEMORY_END 0x040000u
#define LATCHES_END 0x070100u
#define GATE_ICS_END 0x07C000u
#define PHASE_PERIOD 0xFFFF8Cu

bool word_exists(bool x, uint32_t address) {
  if (address < MAIN_MEMORY_END) return true;
  if (address - DPRAM_BASE < DPRAM_SIZE) return hal_strap(HAL_STRAP_DPRAM_WORDS) > 2u * (address - DPRAM_BASE);
  if (address >= SERVO_IC_0_BASE) return address < GATE_ICS_END;
  return x && address >= BOARD_LATCHES_BASE && address < LATCHES_END;
}

uint32_t word_read(bool x, uint32_t address) {
  if (x && address == PHASE_PERIOD) return phase_period() / 2u;
  if (!word_exists(x, address)) return 0;
  uint32_t live;
  if (address < word_hooks.end && word_hooks.read(x, address, &live)) return live & HAL_WORD_MASK;
  return (x ? *hal_x(address) : *hal_y(address)) & HAL_WORD_MASK;
}

void word_write(bool x, uint32_t address, uint32_t value) {
  if (address < word_hooks.end && word_hooks.write(x, address, value & HAL_WORD_MASK)) return;
  if (word_exists(x, address)) *(x ? hal_x(address) : hal_y(address)) = value & HAL_WORD_MASK;
}
