#include "firmware/motion/plan.h"

#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/plan_cubic.h"
#include "firmware/motion/plan_linear.h"
#include "firmware/motion/plan_own.h"
#include "firmware/motion/plan_path.h"

/* Virtual axes have no motors with speeds of their own: RAPID is an unblended move at the feedrate there. Arcs without
 * segmentation are straight. */
enum run_time_error plan_line(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  switch (s->mode) {
    case MODE_RAPID:
      if (s->motors == 0) break;
      plan_rapid(cs);
      return RUN_TIME_NONE;
    case MODE_PVT:
      plan_pvt(cs);
      return RUN_TIME_NONE;
    case MODE_SPLINE1:
    case MODE_SPLINE2:
      plan_spline(cs);
      return RUN_TIME_NONE;
    default:
      break;
  }
  if (s->by_segments) return plan_path(cs);
  return plan_linear(cs) ? RUN_TIME_NONE : RUN_TIME_FEEDRATE;
}
