/* A value of two words that one task publishes and another reads: with a mask, or without, which is a race. Compiled as
 * the firmware is, to show that interrupts anywhere (fake_interrupts.h) find it. */
#ifndef TESTBENCH_UNIT_FIRMWARE_PROGRAM_PUBLISHED_H
#define TESTBENCH_UNIT_FIRMWARE_PROGRAM_PUBLISHED_H

/* NOLINTBEGIN(modernize-*): C, also where C++ includes it */
#include <stdbool.h>
#include <stdint.h>

struct published {
  uint32_t first, second; /* always the same */
  uint64_t wide;          /* both halves the same */
};
extern struct published published;

void publish_words(uint32_t value, bool masked);
void publish_wide(uint32_t value, bool masked);
uint64_t read_published(bool masked);
/* NOLINTEND(modernize-*) */

#endif
