#include "firmware/run/plc_control.h"

#include "firmware/base/memory_map.h"
#include "firmware/buffers/fixed_programs.h"
#include "firmware/hal/hal.h"

#define STOPPED (1u << 22) /* in the word of a PLC */

/* Background and real-time task, under the mask. */
static volatile uint32_t enabled, paused, begins;

/* One at a time: the mask is short, and who comes last has shown what is so. */
static void show(uint32_t plcs) {
  for (uint32_t plc = 0; plcs != 0; plc++, plcs >>= 1) {
    if ((plcs & 1u) == 0) continue;
    const uint32_t state = hal_mask_real_time();
    *hal_y(MEMORY_PLC_STATUS + plc) = (plc_enabled() >> plc & 1u) != 0 ? 0 : STOPPED;
    hal_unmask(state);
  }
}

void plc_control_initialize(void) {
  enabled = paused = 0;
  for (uint32_t i = 0; i < fixed_programs_count(); i++)
    if (fixed_program_at(i)->kind == FIXED_PLC) enabled |= 1u << fixed_program_at(i)->number;
  begins = enabled;
  show(PLC_ALL);
}

void plc_enable(uint32_t plcs) {
  const uint32_t state = hal_mask_real_time();
  begins |= plcs & ~plc_enabled();
  enabled |= plcs;
  paused &= ~plcs;
  hal_unmask(state);
  show(plcs);
}

void plc_disable(uint32_t plcs) {
  const uint32_t state = hal_mask_real_time();
  enabled &= ~plcs;
  paused &= ~plcs;
  hal_unmask(state);
  show(plcs);
}

void plc_pause(uint32_t plcs) {
  const uint32_t state = hal_mask_real_time();
  paused |= plcs & enabled;
  hal_unmask(state);
  show(plcs);
}

void plc_resume(uint32_t plcs) {
  const uint32_t state = hal_mask_real_time();
  paused &= ~plcs;
  hal_unmask(state);
  show(plcs);
}

uint32_t plc_enabled(void) { return enabled & ~paused; }

bool plc_is_paused(uint32_t plc) { return (paused >> plc & 1u) != 0; }

bool plc_begins(uint32_t plc) {
  const uint32_t bit = 1u << plc, state = hal_mask_real_time();
  const bool anew = (begins & bit) != 0;
  begins &= ~bit;
  hal_unmask(state);
  return anew;
}
