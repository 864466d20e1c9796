/* One real-time interrupt: what the panel selects and how BREQ stands come before the calculation of lines, which may
 * take long. */
#include "firmware/image/real_time.h"

#include "firmware/buffers/buffer_request.h"
#include "firmware/host/panel.h"
#include "firmware/run/calculate.h"

void real_time(void) {
  panel_select();
  buffer_request_poll();
  calculate_programs();
}
