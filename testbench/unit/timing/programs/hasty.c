/* The firmware with one bad access: now and then, as it strobes the watchdog, it lowers the gate ICs' wait states to
 * two and reads a word of a servo IC before it puts them back. Linked around hal_watchdog_strobe (--wrap). */
#include "firmware/hal/hal.h"
#include "rtl/regs/brick_regs.h"

void __real_hal_watchdog_strobe(void);
void __wrap_hal_watchdog_strobe(void);
uint32_t hasty_read(uint32_t address);

__attribute__((noinline)) uint32_t hasty_read(uint32_t address) {
  volatile uint32_t* const bcr = hal_x(CPU_BUS_X_BCR);
  const uint32_t state = hal_mask_all(), before = *bcr;
  *bcr = (before & ~0x3E0u) | 2u << 5;
  const uint32_t word = *hal_x(address);
  *bcr = before;
  hal_unmask(state);
  return word;
}

void __wrap_hal_watchdog_strobe(void) {
  static uint32_t strobes; /* real-time task, and start-up before it runs */
  __real_hal_watchdog_strobe();
  if (++strobes % 4u == 0u) (void)hasty_read(0x078006u);
}
