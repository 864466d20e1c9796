/* Start-up, the background loop and the global status word (firmware.md 8.1, 8.4). */
#include "firmware/kernel/kernel.h"

#include "firmware/hal/gate_ic.h"
#include "firmware/hal/hal.h"
#include "firmware/host/command.h"
#include "firmware/host/host_port.h"
#include "firmware/host/line_input.h"
#include "firmware/kernel/internal.h"
#include "firmware/motion/motion.h"
#include "firmware/variables/variables.h"

#define MAIN_MEMORY_WORDS 0x010800u
#define GLOBAL_STATUS 0x000006u /* X: first word, Y: second */

static volatile uint32_t work;   /* set by any task, cleared by the background */
static volatile uint32_t status; /* sticky bits, set by any task */
static uint32_t initial_ics;     /* ICs found at the last re-initialisation */

void kernel_wake_background(void) { work = 1; }

void kernel_status_set(uint32_t bits) {
  const uint32_t state = hal_mask_servo();
  status |= bits;
  hal_unmask(state);
}

uint32_t kernel_status_word(void) { return status | (clock_watch_missing() ? (uint32_t)STATUS_NO_PHASE_CLOCK : 0u); }

bool kernel_motors_may_enable(void) { return (kernel_status_word() & (STATUS_NO_PHASE_CLOCK | STATUS_CONFIGURATION)) == 0u; }

void kernel_save(void) { saved_data_write(initial_ics); }

/* Defaults first, then what was saved over them, unless defaults were asked for. */
static void load_variables(kernel_start_t mode) {
  hal_clear_words(0, MAIN_MEMORY_WORDS);
  i_variable_initialize();
  initial_ics = gate_ic_found();
  if (mode == KERNEL_START_DEFAULTS || (hal_strap(HAL_STRAP_E3) & 1u) != 0u) return;
  if (saved_data_restore(&initial_ics) == SAVED_DAMAGED) status |= STATUS_FLASH_ERROR;
  if (initial_ics != gate_ic_found()) status |= STATUS_CONFIGURATION;
}

void kernel_start(kernel_start_t mode) {
  hal_interrupts_off();
  hal_host_signals(0, HAL_SIGNAL_IPOS | HAL_SIGNAL_BREQ | HAL_SIGNAL_EROR | HAL_SIGNAL_F1ER);
  status = 0;
  gate_ic_find();
  load_variables(mode);
  bus_setup((uint32_t)i_integer(52), (uint32_t)i_integer(37));
  i_variable_write_hardware();
  command_initialize();
  motion_initialize();
  tasks_initialize();
  hal_interrupts_on();
  clock_watch_start();
  work = 1;
}

void kernel_background_pass(void) {
  clock_watch_pass();
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
  bus_setup_first();
  host_port_initialize();
  line_input_initialize();
  kernel_start(KERNEL_START_SAVED);
  for (;;) {
    if (clock_watch_close())
      clock_watch_poll();
    else
      hal_idle(&work);
    if (work == 0u) continue;
    work = 0;
    kernel_background_pass();
  }
}
#endif
