#include "firmware/motion/lookahead_buffer.h"

#include "firmware/buffers/regions.h"
#include "firmware/buffers/user_memory.h"
#include "firmware/kernel/slice.h"

enum { RECORD_WORDS = 4, MOTOR_WORDS = 2 };

_Static_assert(sizeof(struct lookahead_record) <= RECORD_WORDS * sizeof(uint64_t), "a record is four words");
_Static_assert(sizeof(struct lookahead_motor) == MOTOR_WORDS * sizeof(uint64_t), "a motor is two words");

/* One a word of user memory. Written before they are read; no start clears them: that takes 1.5 ms. */
static uint64_t words[USER_MEMORY_WORDS] __attribute__((section(".noinit")));

static uint32_t slots_of[COORDINATE_SYSTEMS];

void lookahead_buffer_define(uint32_t cs, uint32_t slots) { slots_of[cs] = slots; }

bool lookahead_buffer_is_defined(uint32_t cs) { return region_words(REGION_LOOKAHEAD, cs) != 0; }

bool lookahead_buffer_is_anywhere(void) {
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++)
    if (lookahead_buffer_is_defined(cs)) return true;
  return false;
}

/* Behind the records. */
uint32_t lookahead_slots(uint32_t cs, void** slots) {
  const uint32_t size = region_words(REGION_LOOKAHEAD, cs);
  if (size == 0) return 0;
  *slots = &words[region_base(REGION_LOOKAHEAD, cs) + size - LOOKAHEAD_WORDS_PER_OUTPUT * slots_of[cs]];
  return slots_of[cs];
}

void lookahead_buffer_open(uint32_t cs, uint32_t motor_count, struct lookahead_buffer* buffer) {
  buffer->words = &words[region_base(REGION_LOOKAHEAD, cs)];
  slice_pause();
  buffer->stride = RECORD_WORDS + MOTOR_WORDS * motor_count;
  const uint32_t size = region_words(REGION_LOOKAHEAD, cs);
  buffer->records = size == 0 ? 0u : (size - LOOKAHEAD_WORDS_PER_OUTPUT * slots_of[cs]) / buffer->stride;
}
