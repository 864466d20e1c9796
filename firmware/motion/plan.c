#include "firmware/motion/plan.h"

#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/plan_cubic.h"
#include "firmware/motion/plan_linear.h"
#include "firmware/motion/plan_own.h"

/* Virtual axes have no motors with speeds of their own: RAPID is an unblended move at the feedrate there. Arcs without
 * segmentation are straight. */
bool plan_line(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  switch (s->mode) {
    case MODE_RAPID:
      if (s->motors == 0) break;
      plan_rapid(cs);
      return true;
    case MODE_PVT:
      plan_pvt(cs);
      return true;
    case MODE_SPLINE1:
    case MODE_SPLINE2:
      plan_spline(cs);
      return true;
    default:
      break;
  }
  return plan_linear(cs);
}
