#include "firmware/motion/time_base.h"

#include "firmware/hal/hal.h"
#include "firmware/motion/coordinate_system.h"

void time_base_slew(uint32_t cs, int32_t target, enum i_name rate) {
  struct coordinate_system* s = &coordinate_systems[cs];
  s->increment_slew = i_integer(i_cs(cs, rate));
  s->increment_target = target;
  cs_busy |= 1u << cs;
}

void time_base_command(uint32_t cs, int32_t command) {
  struct coordinate_system* s = &coordinate_systems[cs];
  const uint32_t state = hal_mask_servo();
  s->increment_command = command;
  if (!s->held) time_base_slew(cs, command, ISX94_TIME_BASE_SLEW);
  hal_unmask(state);
}
