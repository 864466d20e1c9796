/* Control panel: FPDn/ select one of eight coordinate systems in the group of I59, the other inputs act on it when they
 * go low. With nothing selected four of them set I59 instead. FPDn/ select a motor in the same way, of all four groups:
 * JOG+ and JOG- move it while they are low, PREJ and HOME when they go low. A motor that may not move stands. */
#include "firmware/host/panel.h"

#include "firmware/base/dimensions.h"
#include "firmware/buffers/buffer_request.h"
#include "firmware/command/motor_commands.h"
#include "firmware/hal/hal.h"
#include "firmware/run/motor_stops.h"
#include "firmware/run/run_control.h"
#include "firmware/variables/i_variables.h"
#include "rtl/regs/brick_regs.h"

enum { SELECTABLE = 8 };

static bool fitted;
static uint32_t low;              /* inputs that are pulled low, as 1, at the last pass. Background */
static uint32_t jogging = MOTORS; /* motor that JOG+ or JOG- moves, and which of them. Background */
static uint32_t jogged_by;
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
  jogging = MOTORS;
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
    motors_abort(cs);
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

static void stop_jogging(void) {
  if (jogging != MOTORS) (void)motor_jog(jogging, MOTOR_JOG_STOP);
  jogging = MOTORS;
}

/* What it is not allowed to do it does not: there is nobody to tell. */
static void act_on_motor(uint32_t motor, uint32_t now, uint32_t pulled) {
  const uint32_t jogs = JPAN_INPUTS_JOG_MINUS_MASK | JPAN_INPUTS_JOG_PLUS_MASK;
  if ((now & jogged_by) == 0u || jogging != motor) stop_jogging(); /* the other one may be low still */
  if ((pulled & JPAN_INPUTS_PREJOG_MASK) != 0u) (void)motor_jog(motor, MOTOR_JOG_BACK);
  if ((pulled & JPAN_INPUTS_HOME_MASK) != 0u) (void)motor_jog(motor, MOTOR_HOME);
  if ((pulled & jogs) == 0u || (now & jogs) == jogs) return; /* both at once: neither */
  const bool plus = (pulled & JPAN_INPUTS_JOG_PLUS_MASK) != 0u;
  if (motor_jog(motor, plus ? MOTOR_JOG_PLUS : MOTOR_JOG_MINUS) != ERR_NONE) return;
  jogging = motor;
  jogged_by = pulled & jogs;
}

static void act_on_selection(uint32_t n, uint32_t now, uint32_t pulled) {
  if (n == 0u || n > SELECTABLE) {
    stop_jogging();
    if (n == 0u) choose_group(pulled);
    return;
  }
  if (pulled != 0u) act(selected(n), pulled);
  act_on_motor(n - 1u + SELECTABLE * (uint32_t)i_integer(I59_CONTROL_PANEL_GROUP), now, pulled);
}

void panel_pass(void) {
  if (!fitted) return;
  const uint32_t now = read_low();
  const uint32_t pulled = now & ~low, changed = now ^ low;
  low = now;
  if (!is_active()) {
    stop_jogging();
  } else if (changed != 0u) {
    act_on_selection(number(now), now, pulled);
  }
}
