/* One real-time interrupt: what stops things, what the panel selects and how BREQ stands come before the calculation of
 * lines. */
#include "firmware/image/real_time.h"

#include "firmware/buffers/buffer_request.h"
#include "firmware/host/line_input.h"
#include "firmware/host/panel.h"
#include "firmware/run/calculate.h"

void real_time(void) {
  line_input_urgent();
  panel_select();
  buffer_request_poll();
  calculate_programs();
}
