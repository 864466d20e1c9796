#include "testbench/unit/firmware_program/published.h"

#include "firmware/hal/hal.h"

struct published published;

void publish_words(uint32_t value, bool masked) {
  const uint32_t state = masked ? hal_mask_servo() : 0u;
  published.first = value;
  published.second = value;
  if (masked) hal_unmask(state);
}

void publish_wide(uint32_t value, bool masked) {
  const uint32_t state = masked ? hal_mask_servo() : 0u;
  published.wide = (uint64_t)value << 32 | value;
  if (masked) hal_unmask(state);
}

uint64_t read_published(bool masked) {
  const uint32_t state = masked ? hal_mask_servo() : 0u;
  const uint64_t value = published.wide;
  if (masked) hal_unmask(state);
  return value;
}
