#include "firmware/motion/time_base.h"

#include "firmware/base/memory_map.h"
#include "firmware/hal/hal.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/variables/words.h"

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
  if (!s->held && !s->settling) time_base_slew(cs, command, ISX94_TIME_BASE_SLEW);
  hal_unmask(state);
}

int32_t time_base_external(const struct coordinate_system* s) {
  const int32_t external = hal_signed(*s->time_base_source);
  return external < 0 ? 0 : external;
}

void time_base_stay(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  const uint32_t state = hal_mask_servo();
  s->increment_target = s->increment;
  hal_unmask(state);
}

void time_base_go_on(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  const uint32_t state = hal_mask_servo();
  if (s->held) time_base_slew(cs, s->increment_command, ISX95_FEED_HOLD_SLEW);
  s->increment_target = s->increment_command;
  s->held = false;
  cs_busy |= 1u << cs;
  hal_unmask(state);
}

/* The time base words of systems are not in memory: those are what these have. An address where nothing is holds time.
 */
static const volatile uint32_t* source(uint32_t cs, uint32_t address) {
  static const volatile uint32_t zero;
  const uint32_t inside = address - MEMORY_CS_WORDS, other = inside / MEMORY_CS_STRIDE;
  if (address == MEMORY_CS_WORDS + MEMORY_CS_STRIDE * cs) return 0;
  if (other < COORDINATE_SYSTEMS && inside % MEMORY_CS_STRIDE == 0u)
    return (const volatile uint32_t*)&coordinate_systems[other].increment_command;
  if (other < COORDINATE_SYSTEMS && inside % MEMORY_CS_STRIDE == 2u)
    return (const volatile uint32_t*)&coordinate_systems[other].increment;
  return word_exists(true, address) ? hal_x(address) : &zero;
}

void time_base_source_changed(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  const uint32_t address = (uint32_t)i_integer(i_cs(cs, ISX93_TIME_BASE_ADDRESS));
  const uint32_t state = hal_mask_servo();
  s->time_base_source = source(cs, address);
  cs_busy |= 1u << cs;
  hal_unmask(state);
  time_base_slew_changed(cs);
}

void time_base_slew_changed(uint32_t cs) {
  struct coordinate_system* s = &coordinate_systems[cs];
  const uint32_t state = hal_mask_servo();
  s->increment_usual = i_integer(i_cs(cs, ISX94_TIME_BASE_SLEW));
  if (!s->held) s->increment_slew = s->increment_usual;
  hal_unmask(state);
}

void time_base_initialize(void) {
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++) time_base_source_changed(cs);
}
