/* Where the user buffers end: a Geo PMAC has a page of device registers in main memory (servo-ic:11.4), and buffers end
 * below it. */
#ifndef FIRMWARE_BASE_BUFFERS_END_H
#define FIRMWARE_BASE_BUFFERS_END_H

#include "firmware/base/memory_map.h"
#include "firmware/hal/hal.h"
#include "rtl/regs/brick_regs.h"

static inline uint32_t memory_buffers_end(void) {
  return (hal_strap(HAL_STRAP_PRODUCT) & HAL_PRODUCT_GEO_PMAC) != 0u ? SSI_PAGE_BASE : MEMORY_BUFFERS_END;
}

#endif
