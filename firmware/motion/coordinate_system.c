/* State of the coordinate systems at start-up, and the modes that programs and hosts set alike. */
#include "firmware/motion/coordinate_system.h"

#include "firmware/base/dimensions.h"
#include "firmware/hal/hal.h"
#include "firmware/variables/i_variables.h"

struct coordinate_system coordinate_systems[COORDINATE_SYSTEMS];
volatile uint32_t cs_busy, cs_awake;
uint32_t cs_interrupts;

/* A motor belongs to one system at a time: all rings have their cubics here, each those of its motors. */
static struct cubic cubics[PIECES * MOTORS] __attribute__((section(".noinit"))); /* written with its piece */

void coordinate_systems_initialize(void) {
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++) {
    struct coordinate_system* s = &coordinate_systems[cs];
    *s = (struct coordinate_system){0};
    s->feedrate_axes = AXIS_XYZ;
    s->normal[2] = -1.0;
    s->segment_override = SEGMENT_OVERRIDE_ONE;
    piece_ring_initialize(&s->ring, cubics, MOTORS);
    s->increment_full = s->increment_command = i_integer(I10_SERVO_PERIOD);
    s->increment = s->increment_target = s->increment_full;
  }
  cs_busy = cs_awake = 0;
}

void coordinate_systems_forget_programs(void) {
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++) coordinate_systems[cs].pointer = POINTER_NONE;
}

/* Program and host may change different axes at the same time: neither loses what the other has set. */
void cs_set_axis_mode(struct coordinate_system* s, enum operation operation, uint32_t mask) {
  if (operation == OP_FRAX) {
    s->feedrate_axes = mask & AXIS_ALL;
    return;
  }
  const bool incremental = operation == OP_INC;
  const uint32_t state = hal_mask_real_time();
  s->incremental = incremental ? s->incremental | (mask & AXIS_ALL) : s->incremental & ~mask;
  if (mask & AXIS_VECTOR) s->vector_absolute = !incremental;
  hal_unmask(state);
}
