/* The image's main program, entered from crt0.S: start-up, then the background task for ever. */
#include "firmware/hal/hal.h"
#include "firmware/host/host_port.h"
#include "firmware/host/line_input.h"
#include "firmware/image/background_pass.h"
#include "firmware/image/fault.h"
#include "firmware/image/start.h"
#include "firmware/kernel/background.h"
#include "firmware/kernel/bus_setup.h"
#include "firmware/kernel/clock_watch.h"

_Noreturn void image_main(void);

_Noreturn void image_main(void) {
  bus_setup_first(); /* before the first device access */
  host_port_initialize();
  line_input_initialize();
  start(START_SAVED);
  fault_start_done();
  for (;;) {
    if (clock_watch_close())
      clock_watch_poll();
    else
      hal_idle(&background_work);
    if (background_work == 0u) {
      line_input_text();
      continue;
    }
    background_work = 0;
    background_pass();
  }
}
