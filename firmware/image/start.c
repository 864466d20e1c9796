/* Start-up (firmware:8.4): clocks, variables, memory, and every layer in its turn. */
#include "firmware/image/start.h"

#include "firmware/base/buffers_end.h"
#include "firmware/base/status.h"
#include "firmware/buffers/buffer_request.h"
#include "firmware/buffers/compensation_tables.h"
#include "firmware/buffers/fixed_programs.h"
#include "firmware/buffers/gather.h"
#include "firmware/buffers/open_buffer.h"
#include "firmware/buffers/program_password.h"
#include "firmware/buffers/regions.h"
#include "firmware/buffers/rotary.h"
#include "firmware/command/session.h"
#include "firmware/hal/gate_ic.h"
#include "firmware/hal/hal.h"
#include "firmware/host/binary_rotary.h"
#include "firmware/host/dpram_functions.h"
#include "firmware/host/panel.h"
#include "firmware/host/program_texts.h"
#include "firmware/image/fault.h"
#include "firmware/image/saved_data.h"
#include "firmware/kernel/background.h"
#include "firmware/kernel/bus_setup.h"
#include "firmware/kernel/calendar.h"
#include "firmware/kernel/clock_watch.h"
#include "firmware/kernel/tasks.h"
#include "firmware/motion/axis_definition.h"
#include "firmware/motion/axis_matrix.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/jog.h"
#include "firmware/motion/motor_variables.h"
#include "firmware/motion/phase_search.h"
#include "firmware/motion/phase_task.h"
#include "firmware/motion/phasing.h"
#include "firmware/motion/power_on_position.h"
#include "firmware/motion/protection.h"
#include "firmware/motion/sine_table.h"
#include "firmware/motion/time_base.h"
#include "firmware/run/calculate.h"
#include "firmware/run/plc.h"
#include "firmware/variables/i_variables.h"
#include "firmware/variables/ssi_inputs.h"

enum { CLEARED_AT_ONCE = MEMORY_BUFFERS_END / 8 };
enum { LONGEST_SERVO_MS = 25, SERIAL_FRAME_US = 200 }; /* the watchdog's time; 25 clocks of 153.6 kHz and the rest */

static saved_t saved;        /* what the flash store had for this start */
static uint32_t initial_ics; /* ICs found at the last re-initialisation */

static void load_defaults(void) {
  i_variable_initialize();
  initial_ics = gate_ic_configuration();
}

/* What was saved and the clocks need, or all defaults: if they are asked for, by jumper E3 or `$$$***`, or if nothing
 * good was saved. */
static void load_variables(enum start_mode mode) {
  const bool use_saved = mode == START_SAVED && (hal_strap(HAL_STRAP_E3) & 1u) == 0u;
  saved = use_saved ? saved_data_restore_early(&initial_ics) : SAVED_NONE;
  if (saved != SAVED_GOOD) load_defaults();
}

/* The rest of what was saved is looked at when the clocks run. Is it damaged, the variables are not taken either. */
static void check_saved(void) {
  if (saved == SAVED_GOOD && !saved_data_rest_is_whole()) {
    saved = SAVED_DAMAGED;
    load_defaults();
    i_variable_write_hardware();
  }
  if (saved == SAVED_DAMAGED) status_set(STATUS_FLASH_ERROR);
  if (initial_ics != gate_ic_configuration()) status_set(STATUS_CONFIGURATION);
}

static void clear_memory(uint32_t first, uint32_t end) {
  for (; first < end; first += CLEARED_AT_ONCE) {
    hal_clear_words(first, end - first < CLEARED_AT_ONCE ? end - first : CLEARED_AT_ONCE);
    hal_watchdog_strobe();
  }
}

/* `$$$***` leaves M definitions, P, Q and axis definitions as they are. */
static void clear_user_memory(enum start_mode mode) {
  if (mode == START_DEFAULTS) {
    clear_memory(0, MEMORY_M_DEFINITIONS);
    clear_memory(MEMORY_BUFFERS, memory_buffers_end());
  } else {
    clear_memory(0, memory_buffers_end());
    axis_definition_initialize();
  }
}

static void load_user_memory(enum start_mode mode) {
  clear_user_memory(mode);
  *hal_y(MEMORY_DPRAM_END) = DPRAM_BASE + hal_strap(HAL_STRAP_DPRAM_WORDS) / 2u;
  regions_initialize();
  gather_initialize();
  fixed_programs_initialize();
  compensation_tables_initialize();
  program_password_initialize();
  fault_show();
  if (saved == SAVED_GOOD) saved_data_restore_rest();
}

static bool is_serial(uint32_t motor) {
  return ssi_inputs_have((uint32_t)i_integer(i_motor(motor, IXX10_POWER_ON_ADDRESS))) ||
         ssi_inputs_have((uint32_t)i_integer(i_motor(motor, IXX81_POWER_ON_PHASE_ADDRESS)));
}

/* The first word of a serial encoder begins with the next servo clock. */
static void await_serial_encoders(void) {
  uint32_t motor = 1;
  while (motor <= MOTORS && !is_serial(motor)) ++motor;
  if (motor > MOTORS) return;
  const uint32_t began = hal_cycles(), count = tasks_servo_count();
  while (tasks_servo_count() == count && hal_cycles() - began < LONGEST_SERVO_MS * hal_cycles_per_ms()) {}
  hal_delay_us(SERIAL_FRAME_US);
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
  check_saved();
  load_user_memory(mode);
  i_variable_write_ssi();
  session_initialize();
  rotary_initialize();
  open_buffer_initialize(); /* the selections show what these have cleared */
  buffer_request_initialize();
  panel_initialize();
  coordinate_systems_initialize();
  axis_matrix_initialize();
  time_base_initialize();
  motor_variables_initialize();
  jog_initialize();
  phasing_initialize();
  calculate_initialize();
  plc_initialize();
  program_texts_initialize();
  dpram_functions_initialize();
  binary_rotary_initialize();
  hal_watchdog_strobe();
  bus_setup((uint32_t)i_integer(I52_CPU_FREQUENCY), (uint32_t)i_integer(I37_ADDITIONAL_WAIT_STATES));
  calendar_initialize();
  tasks_initialize();
  phasing_search_initialize();
  phase_task_initialize();
  if (phase_task_work != 0u)
    sine_table_initialize();
  else
    sine_table_later(); /* nobody commutates yet, and a start has 25 ms */
  hal_interrupts_on();
  clock_watch_start();
  await_serial_encoders();
  power_on_positions_read();
  phasing_power_on();
  background_wake();
}

/* Motors move on meanwhile; what protects them waits until it is over, as users know it (motion:6). */
void start_save(void) {
  protection_stand(true);
  saved_data_write(initial_ics);
  protection_stand(false);
}
