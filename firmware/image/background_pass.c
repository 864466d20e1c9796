/* One pass: what the layers have to do now and then, then the host. */
#include "firmware/image/background_pass.h"

#include "firmware/base/memory_map.h"
#include "firmware/base/status.h"
#include "firmware/hal/hal.h"
#include "firmware/host/host_port.h"
#include "firmware/host/line_input.h"
#include "firmware/host/panel.h"
#include "firmware/kernel/background.h"
#include "firmware/kernel/clock_watch.h"
#include "firmware/kernel/watchdog.h"
#include "firmware/motion/motion_status.h"
#include "firmware/variables/i_variables.h"

void background_pass(void) {
  clock_watch_pass();
  panel_pass();
  /* For who looks at memory from outside: users are shown the words as they are (motion/live_words.c). */
  *hal_x(MEMORY_GLOBAL_STATUS) = status_word();
  *hal_y(MEMORY_GLOBAL_STATUS) = motion_global_status2();
  line_input_pass();
  i_variable_apply_clock_directions(); /* written by a program */
  if (host_port_waiting()) background_wake();
  watchdog_reload();
}
