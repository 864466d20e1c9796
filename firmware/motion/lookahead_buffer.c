#include "firmware/motion/lookahead_buffer.h"

#include "firmware/buffers/regions.h"
#include "firmware/buffers/user_memory.h"

enum { RECORD_WORDS = 4, MOTOR_WORDS = 2 };

_Static_assert(sizeof(struct lookahead_record) <= RECORD_WORDS * sizeof(uint64_t), "a record is four words");
_Static_assert(sizeof(struct lookahead_motor) == MOTOR_WORDS * sizeof(uint64_t), "a motor is two words");

/* One a word of user memory. Written before they are read; no start clears them: that takes 1.5 ms. */
static uint64_t words[USER_MEMORY_WORDS] __attribute__((section(".noinit")));

void lookahead_buffer_open(uint32_t cs, uint32_t motor_count, struct lookahead_buffer* buffer) {
  buffer->words = &words[region_base(REGION_LOOKAHEAD, cs)];
  buffer->stride = RECORD_WORDS + MOTOR_WORDS * motor_count;
  buffer->records = region_words(REGION_LOOKAHEAD, cs) / buffer->stride;
}
