/* One pass: the host, then what the layers have to do now and then and a scan of a PLC: BREQ must not wait for them
 * (host-bus:5.7, T_FALL). */
#include "firmware/image/background_pass.h"

#include "firmware/base/memory_map.h"
#include "firmware/base/status.h"
#include "firmware/hal/hal.h"
#include "firmware/host/binary_rotary.h"
#include "firmware/host/dpram_functions.h"
#include "firmware/host/host_port.h"
#include "firmware/host/line_input.h"
#include "firmware/host/panel.h"
#include "firmware/host/program_texts.h"
#include "firmware/kernel/background.h"
#include "firmware/kernel/clock_watch.h"
#include "firmware/kernel/image_checksum.h"
#include "firmware/kernel/slice.h"
#include "firmware/kernel/stack_watch.h"
#include "firmware/kernel/watchdog.h"
#include "firmware/motion/conversion_table.h"
#include "firmware/motion/desired_position.h"
#include "firmware/motion/motion_status.h"
#include "firmware/motion/phase_search.h"
#include "firmware/motion/sine_table.h"
#include "firmware/run/plc.h"
#include "firmware/run/restart.h"
#include "firmware/variables/i_hardware.h"
#include "firmware/variables/i_variables.h"

enum { REPLY_MS = 5, LINE_MS = 2 }; /* to the next turn of the rest: between lines of replies, while a line comes */

static uint32_t came_by; /* cycle counter at the end of the last */

void background_meanwhile(void) {
  panel_pass();
  /* For who looks at memory from outside: users are shown the words as they are (motion/live_words.c). */
  *hal_x(MEMORY_GLOBAL_STATUS) = status_word();
  *hal_y(MEMORY_GLOBAL_STATUS) = motion_global_status2();
  if (plc_background_any()) {
    plc_background();
    background_wake();
  }
  desired_position_pass();
  phasing_pass();
  restart_pass();
  sine_table_pass();
  image_checksum_pass();
  stack_watch_pass();
  i_timers_pass();
  watchdog_reload();
  came_by = hal_cycles();
}

static bool came_by_within(uint32_t ms) { return hal_cycles() - came_by <= ms * hal_cycles_per_ms(); }

/* A host that reads as fast as lines are made, or a port that takes them all, never makes a reply wait. */
void background_between_lines(void) {
  if (!came_by_within(REPLY_MS)) background_meanwhile();
}

void background_pass(void) {
  clock_watch_pass();
  line_input_pass();
  dpram_functions_pass();
  if (slice_hurry != 0u && came_by_within(LINE_MS)) return; /* a line is on its way: its end begins the next pass */
  binary_rotary_pass();
  program_texts_pass();
  conversion_table_pass();
  background_meanwhile();
  i_hardware_apply_clock_directions(); /* written by a program */
  if (host_port_waiting()) background_wake();
}
