/* Start-up (firmware:8.4): clocks, variables, memory, and every layer in its turn. */
#include "firmware/image/start.h"

#include "firmware/base/memory_map.h"
#include "firmware/base/status.h"
#include "firmware/buffers/buffer_request.h"
#include "firmware/buffers/fixed_programs.h"
#include "firmware/buffers/open_buffer.h"
#include "firmware/buffers/regions.h"
#include "firmware/buffers/rotary.h"
#include "firmware/command/session.h"
#include "firmware/hal/gate_ic.h"
#include "firmware/hal/hal.h"
#include "firmware/host/panel.h"
#include "firmware/image/fault.h"
#include "firmware/image/saved_data.h"
#include "firmware/kernel/background.h"
#include "firmware/kernel/bus_setup.h"
#include "firmware/kernel/calendar.h"
#include "firmware/kernel/clock_watch.h"
#include "firmware/kernel/tasks.h"
#include "firmware/motion/axis_definition.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/motor_status.h"
#include "firmware/motion/phase_task.h"
#include "firmware/run/calculate.h"
#include "firmware/run/plc_control.h"
#include "firmware/variables/i_variables.h"

enum { CLEARED_AT_ONCE = MEMORY_BUFFERS_END / 8 };

static bool load_user;       /* user memory was saved */
static uint32_t initial_ics; /* ICs found at the last re-initialisation */

/* What was saved, or the defaults: if they are asked for, by jumper E3 or `$$$***`, or if nothing good was saved. */
static void load_variables(enum start_mode mode) {
  const bool use_saved = mode == START_SAVED && (hal_strap(HAL_STRAP_E3) & 1u) == 0u;
  const saved_t saved = use_saved ? saved_data_restore_variables(&initial_ics) : SAVED_NONE;
  if (saved == SAVED_DAMAGED) status_set(STATUS_FLASH_ERROR);
  if (saved != SAVED_GOOD) {
    i_variable_initialize();
    initial_ics = gate_ic_configuration();
  }
  if (initial_ics != gate_ic_configuration()) status_set(STATUS_CONFIGURATION);
  load_user = saved == SAVED_GOOD;
}

static void load_user_memory(void) {
  for (uint32_t first = 0; first < MEMORY_BUFFERS_END; first += CLEARED_AT_ONCE) {
    hal_clear_words(first, CLEARED_AT_ONCE);
    hal_watchdog_strobe();
  }
  axis_definition_initialize();
  *hal_y(MEMORY_DPRAM_END) = DPRAM_BASE + hal_strap(HAL_STRAP_DPRAM_WORDS) / 2u;
  regions_initialize();
  fixed_programs_initialize();
  fault_show();
  if (load_user) saved_data_restore_user_memory();
}

/* The hardware watchdog runs from reset on: 25 ms for the first servo clock edge, and 25 ms from strobe to strobe. So
 * the clocks come first, at the CPU clock after reset, and the steps that take long are strobed. */
void start(enum start_mode mode) {
  hal_interrupts_off();
  hal_watchdog_strobe();
  bus_setup_first();
  hal_host_signals(0, HAL_SIGNAL_IPOS | HAL_SIGNAL_BREQ | HAL_SIGNAL_EROR | HAL_SIGNAL_F1ER);
  status_initialize();
  gate_ic_find();
  load_variables(mode);
  i_variable_write_hardware();
  hal_watchdog_strobe();
  load_user_memory();
  session_initialize();
  panel_initialize();
  coordinate_systems_initialize();
  calculate_initialize();
  plc_control_initialize();
  motor_status_initialize();
  rotary_initialize();
  open_buffer_initialize();
  buffer_request_initialize();
  hal_watchdog_strobe();
  bus_setup((uint32_t)i_integer(I52_CPU_FREQUENCY), (uint32_t)i_integer(I37_ADDITIONAL_WAIT_STATES));
  calendar_initialize();
  tasks_initialize();
  phase_task_initialize();
  hal_interrupts_on();
  clock_watch_start();
  background_wake();
}

void start_save(void) { saved_data_write(initial_ics); }
