/* Control panel: FPDn/ select one of eight coordinate systems in the group of I59, the other inputs act on it when they
 * go low. With nothing selected four of them set I59 instead. JOG, PREJ and HOME of a selected motor ask for nothing:
 * motors are not moved by commands yet. */
#include "firmware/host/panel.h"

#include "firmware/base/dimensions.h"
#include "firmware/buffers/buffer_request.h"
#include "firmware/hal/hal.h"
#include "firmware/run/run_control.h"
#include "firmware/variables/i_variables.h"
#include "rtl/regs/brick_regs.h"

enum { SELECTABLE = 8 };

static bool fitted;
static uint32_t low;                /* inputs that are pulled low, as 1, at the last pass. Background */
static volatile uint32_t selection; /* number that FPDn/ give. Real-time task */

static uint32_t read_low(void) {
  return ~*hal_y(JPAN_Y_INPUTS) & JPAN_INPUTS_RESET & ~(uint32_t)JPAN_INPUTS_SPARE_MASK;
}

static uint32_t number(uint32_t inputs) { return (inputs & JPAN_INPUTS_FPD_MASK) >> JPAN_INPUTS_FPD_SHIFT; }

static bool is_active(void) { return fitted && ((uint32_t)i_integer(I2_CONTROL_PANEL_DISABLE) & 1u) == 0u; }

/* Groups 2 and 3 of I59 are further motors, not further systems. */
static uint32_t selected(uint32_t n) {
  if (n == 0u || n > SELECTABLE) return COORDINATE_SYSTEMS;
  return n - 1u + SELECTABLE * ((uint32_t)i_integer(I59_CONTROL_PANEL_GROUP) & 1u);
}

uint32_t panel_cs(void) { return selected(selection); }

/* What the panel has selected goes before the host's selection while I2 lets it. */
void panel_changed(void) {
  const uint32_t state =
      hal_mask_real_time(); /* a selection of the real-time task in between must not be overwritten */
  buffer_request_panel_selects(is_active() ? panel_cs() : PANEL_IS_OFF);
  hal_unmask(state);
}

void panel_initialize(void) {
  fitted = (hal_strap(HAL_STRAP_PRODUCT) & HAL_PRODUCT_JPAN) != 0u;
  low = fitted ? read_low() : 0u;
  selection = number(low);
  panel_changed();
}

void panel_select(void) {
  if (!fitted) return;
  selection = number(read_low());
  panel_changed();
}

static void choose_group(uint32_t pulled) {
  static const uint32_t inputs[] = {JPAN_INPUTS_HOME_MASK, JPAN_INPUTS_PREJOG_MASK, JPAN_INPUTS_START_MASK,
                                    JPAN_INPUTS_STEP_MASK};
  for (unsigned group = 0; group < sizeof inputs / sizeof inputs[0]; ++group)
    if ((pulled & inputs[group]) != 0u) i_variable_write(I59_CONTROL_PANEL_GROUP, group);
}

static void act(uint32_t cs, uint32_t pulled) {
  if ((pulled & JPAN_INPUTS_STOP_MASK) != 0u) {
    run_abort(cs);
    return; /* stopping wins */
  }
  if ((pulled & JPAN_INPUTS_HOLD_MASK) != 0u) run_hold(cs);
  if ((pulled & JPAN_INPUTS_START_MASK) != 0u) (void)run_start(cs, false);
  if ((pulled & JPAN_INPUTS_STEP_MASK) == 0u) return;
  if (run_is_running(cs))
    run_quit(cs);
  else
    (void)run_start(cs, true);
}

void panel_pass(void) {
  if (!fitted) return;
  const uint32_t now = read_low();
  const uint32_t pulled = now & ~low;
  low = now;
  if (pulled == 0u || !is_active()) return;
  if (number(now) == 0u)
    choose_group(pulled);
  else if (selected(number(now)) != COORDINATE_SYSTEMS)
    act(selected(number(now)), pulled);
}
