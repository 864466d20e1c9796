/* One real-time interrupt: what stops things, what the panel selects and how BREQ stands come before the checks of
 * motors and the calculation of lines; PLC 0 is the last. */
#include "firmware/image/real_time.h"

#include "firmware/buffers/buffer_request.h"
#include "firmware/host/binary_rotary.h"
#include "firmware/host/host_port.h"
#include "firmware/host/line_input.h"
#include "firmware/host/panel.h"
#include "firmware/kernel/stack_watch.h"
#include "firmware/kernel/tasks.h"
#include "firmware/motion/protection.h"
#include "firmware/run/calculate.h"
#include "firmware/run/plc.h"

void real_time(void) {
  if (host_port_urgent_codes != 0u) line_input_urgent();
  panel_select();
  buffer_request_poll();
  binary_rotary_real_time();
  if (tasks_real_time_is_periodic() || protection_is_asked_for()) protection_pass();
  calculate_programs();
  if (tasks_real_time_is_periodic()) plc_real_time();
  stack_watch_check();
}
