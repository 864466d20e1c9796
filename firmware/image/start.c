/* Start-up, the background loop and the global status word (firmware:8.1, firmware:8.4). */
#include "firmware/kernel/kernel.h"

#include "firmware/command/command.h"
#include "firmware/hal/gate_ic.h"
#include "firmware/hal/hal.h"
#include "firmware/host/host_port.h"
#include "firmware/host/line_input.h"
#include "firmware/host/panel.h"
#include "firmware/kernel/internal.h"
#include "firmware/motion/motion.h"
#include "firmware/variables/variables.h"
#include "rtl/regs/brick_regs.h"

#define MAIN_MEMORY_WORDS 0x010800u
#define DPRAM_END 0x00003Fu     /* Y: address after the dual-ported RAM, tells its size */
#define CLEARED_AT_ONCE 0x2100u /* an eighth */
#define GLOBAL_STATUS 0x000006u /* X: first word, Y: second */

static volatile uint32_t work;   /* set by any task, cleared by the background */
static volatile uint32_t status; /* sticky bits, set by any task */
static bool load_user;           /* user memory was saved */
static uint32_t initial_ics;     /* ICs found at the last re-initialisation */

void kernel_wake_background(void) { work = 1; }

void kernel_status_set(uint32_t bits) {
  const uint32_t state = hal_mask_servo();
  status |= bits;
  hal_unmask(state);
}

uint32_t kernel_status_word(void) { return status | (clock_watch_missing() ? (uint32_t)STATUS_NO_PHASE_CLOCK : 0u); }

bool kernel_motors_may_enable(void) {
  return (kernel_status_word() & (STATUS_NO_PHASE_CLOCK | STATUS_CONFIGURATION)) == 0u;
}

void kernel_save(void) { saved_data_write(initial_ics); }

/* What was saved, or the defaults: if they are asked for, by jumper E3 or `$$$***`, or if nothing good was saved. */
static void load_variables(kernel_start_t mode) {
  const bool use_saved = mode == KERNEL_START_SAVED && (hal_strap(HAL_STRAP_E3) & 1u) == 0u;
  const saved_t saved = use_saved ? saved_data_restore_variables(&initial_ics) : SAVED_NONE;
  if (saved == SAVED_DAMAGED) status |= STATUS_FLASH_ERROR;
  if (saved != SAVED_GOOD) {
    i_variable_initialize();
    initial_ics = gate_ic_configuration();
  }
  if (initial_ics != gate_ic_configuration()) status |= STATUS_CONFIGURATION;
  load_user = saved == SAVED_GOOD;
}

static void load_user_memory(void) {
  for (uint32_t first = 0; first < MAIN_MEMORY_WORDS; first += CLEARED_AT_ONCE) {
    hal_clear_words(first, CLEARED_AT_ONCE);
    hal_watchdog_strobe();
  }
  *hal_y(DPRAM_END) = DPRAM_BASE + hal_strap(HAL_STRAP_DPRAM_WORDS) / 2u;
  if (load_user) saved_data_restore_user_memory();
}

/* The hardware watchdog runs from reset on: 25 ms for the first servo clock edge, and 25 ms from strobe to strobe. So
 * the clocks come first, at the CPU clock after reset, and the steps that take long are strobed. */
void kernel_start(kernel_start_t mode) {
  hal_interrupts_off();
  hal_watchdog_strobe();
  bus_setup_first();
  hal_host_signals(0, HAL_SIGNAL_IPOS | HAL_SIGNAL_BREQ | HAL_SIGNAL_EROR | HAL_SIGNAL_F1ER);
  status = 0;
  gate_ic_find();
  load_variables(mode);
  i_variable_write_hardware();
  hal_watchdog_strobe();
  load_user_memory();
  command_initialize();
  panel_initialize();
  motion_initialize();
  hal_watchdog_strobe();
  bus_setup((uint32_t)i_integer(52), (uint32_t)i_integer(37));
  tasks_initialize();
  hal_interrupts_on();
  clock_watch_start();
  work = 1;
}

void kernel_background_pass(void) {
  clock_watch_pass();
  panel_pass();
  motion_background_update();
  *hal_x(GLOBAL_STATUS) = kernel_status_word();
  *hal_y(GLOBAL_STATUS) = motion_global_status2();
  line_input_pass();
  i_variable_apply_clock_directions(); /* written by a program */
  if (host_port_waiting()) work = 1;
  kernel_watchdog_reload();
}

#ifndef BRICK_NATIVE
_Noreturn void kernel_main(void);

_Noreturn void kernel_main(void) {
  bus_setup_first(); /* before the first device access */
  host_port_initialize();
  line_input_initialize();
  kernel_start(KERNEL_START_SAVED);
  for (;;) {
    if (clock_watch_close())
      clock_watch_poll();
    else
      hal_idle(&work);
    if (work == 0u) {
      line_input_text();
      continue;
    }
    work = 0;
    kernel_background_pass();
  }
}
#endif
