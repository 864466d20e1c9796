#include "firmware/image/fault.h"

#include "firmware/base/memory_map.h"
#include "firmware/hal/gate_ic.h"
#include "firmware/hal/hal.h"
#include "rtl/regs/brick_regs.h"

/* Neither cleared nor initialised by crt0.S: what power-on leaves there has no two words that belong together. */
#define MARK 0x46415554u
static struct {
  uint32_t mark, inverse;
  uint32_t cause, pc, address, count;
  uint32_t starting; /* since a fault, and not done yet */
} record __attribute__((section(".noinit")));

static bool is_kept(void) { return record.mark == MARK && record.inverse == ~MARK; }

bool fault_take(uint32_t cause, uint32_t pc, uint32_t address) {
  if (is_kept() && record.starting != 0u) return false;
  if (!is_kept()) record.count = 0;
  record.mark = MARK;
  record.inverse = ~MARK;
  record.starting = 1;
  ++record.count;
  record.cause = cause;
  record.pc = pc;
  record.address = address;
  gate_ic_outputs_off();
  *hal_x(BOARD_LATCHES_X_CONTROL_OUTPUTS) = 0;
  return true;
}

static void show_long(uint32_t address, uint32_t value) {
  *hal_x(address) = value >> 24;
  *hal_y(address) = value & HAL_WORD_MASK;
}

void fault_show(void) {
  if (!is_kept()) return;
  *hal_x(MEMORY_FAULT) = (record.cause & 0x7FFFFFu) | (record.cause >> 31) << 23;
  *hal_y(MEMORY_FAULT) = record.count & HAL_WORD_MASK;
  show_long(MEMORY_FAULT + 1u, record.pc);
  show_long(MEMORY_FAULT + 2u, record.address);
}

void fault_start_done(void) { record.starting = 0; }
