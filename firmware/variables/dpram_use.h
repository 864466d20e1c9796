/* Whether the automatic functions have a dual-ported RAM: it is fitted, and I24 names it. */
#ifndef FIRMWARE_VARIABLES_DPRAM_USE_H
#define FIRMWARE_VARIABLES_DPRAM_USE_H

#include "firmware/base/dpram.h"
#include "firmware/variables/i_variables.h"

static inline bool dpram_is_used(void) {
  return (uint32_t)i_integer(I24_DPRAM_BASE) == DPRAM_BASE && dpram_bytes() != 0u;
}

#endif
