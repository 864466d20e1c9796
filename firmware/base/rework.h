/* Settings that are made anew from variables, a motor's integers or a table for the servo task, without holding a task
 * off while that is worked out. Background and real-time task both do it, and the second may come in the middle of the
 * first: it leaves a note then, and the background makes them once more, from the new variables.
 *
 *   uint32_t left = what;
 *   if (!rework_begin(&r, left)) return;
 *   do make(left); while ((left = rework_end(&r)) != 0u);
 */
#ifndef FIRMWARE_BASE_REWORK_H
#define FIRMWARE_BASE_REWORK_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/hal/hal.h"

struct rework {
  volatile bool under_way;
  volatile uint32_t again; /* bits of what has changed meanwhile, by the caller's numbers */
};

/* False: whoever is at it makes it once more. */
static inline bool rework_begin(struct rework* r, uint32_t what) {
  if (r->under_way) {
    r->again |= what;
    return false;
  }
  r->under_way = true;
  return true;
}

/* What is to be made once more; 0: it is over. */
static inline uint32_t rework_end(struct rework* r) {
  const uint32_t state = hal_mask_real_time();
  const uint32_t again = r->again;
  r->again = 0;
  r->under_way = again != 0u;
  hal_unmask(state);
  return again;
}

#endif
