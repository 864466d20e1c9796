/* Clock, and mode and length of each channel in one word. */
#include "firmware/variables/ssi_inputs.h"

#include "firmware/hal/hal.h"
#include "rtl/regs/brick_regs.h"

enum { CLOCK, MODE_1, LENGTH_1, MODE_2, LENGTH_2, SETTINGS }; /* I1015 on */
#define CHANNEL_STRIDE 0x20u                                  /* from channel 1 to channel 2 */

static uint8_t settings[SETTINGS];

static void write_channel(uint32_t channel) {
  const uint32_t mode = settings[MODE_1 + 2u * channel], length = settings[LENGTH_1 + 2u * channel];
  *hal_x(SSI_GEO_X_CONTROL + CHANNEL_STRIDE * channel) =
      mode << SSI_GEO_CONTROL_MODE_SHIFT | length << SSI_GEO_CONTROL_LENGTH_SHIFT;
}

static bool is_fitted(void) { return (hal_strap(HAL_STRAP_PRODUCT) & HAL_PRODUCT_FEEDBACK_2) != 0u; }

bool ssi_inputs_have(uint32_t address) {
  return is_fitted() && (address == SSI_GEO_Y_POSITION || address == SSI_GEO_Y_POSITION + CHANNEL_STRIDE);
}

void ssi_inputs_set(uint32_t which, uint32_t value) {
  settings[which] = (uint8_t)value;
  if (!is_fitted()) return;
  if (which == CLOCK)
    *hal_x(SSI_GEO_X_TIMING) = value;
  else
    write_channel(which < MODE_2 ? 0u : 1u);
}
