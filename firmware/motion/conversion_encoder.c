/* Entries that read an encoder channel of a servo IC: counter, fraction of a count by time or by the IC, triggered time
 * base (motion:2, servo-ic:2.2 to servo-ic:2.4). The IC latches all of it at the servo clock. */
#include "firmware/motion/conversion_encoder.h"

#include "firmware/hal/hal.h"
#include "rtl/regs/brick_regs.h"

enum { TIME_BASE_BITS = 8 };

static const uint32_t CAPTURE = SERVO_CHANNEL_STATUS_CAPTURED_MASK;

/* The IC's fraction counts upwards in both directions. */
void convert_hardware_1t(const struct conversion_entry* entry) {
  const uint32_t counts = (*entry->source[ENCODER_POSITION] >> 1) << CONVERSION_FRACTION;
  *entry->result = (counts | *entry->source[ENCODER_SINCE] >> (24 - CONVERSION_FRACTION)) & HAL_WORD_MASK;
}

void convert_counter(const struct conversion_entry* entry) {
  *entry->result = ((*entry->source[ENCODER_POSITION] >> 1) << CONVERSION_FRACTION) & HAL_WORD_MASK;
}

/* Bits 23 to 19 of the status word: T, U, V, W, USER. */
void convert_sub_count(const struct conversion_entry* entry) {
  const uint32_t counts = (*entry->source[ENCODER_POSITION] >> 1) << CONVERSION_FRACTION;
  *entry->result = (counts | *entry->source[ENCODER_STATUS] >> (24 - CONVERSION_FRACTION)) & HAL_WORD_MASK;
}

/* Reading the captured position arms the trigger. */
void convert_frozen(const struct conversion_entry* entry) {
  (void)*entry->source[ENCODER_CAPTURED];
  *entry->result = 0;
}

/* From the captured position on when the trigger comes, with the first distance in the same interrupt. */
void convert_armed(const struct conversion_entry* entry) {
  struct conversion_state* state = entry->state;
  if (!state->runs) {
    *entry->result = 0;
    if ((*entry->source[ENCODER_STATUS] & CAPTURE) == 0u) return;
    state->runs = true;
    state->previous = *entry->source[ENCODER_CAPTURED] << TIME_BASE_BITS;
  }
  const uint32_t now = conversion_with_time(entry, *entry->source[ENCODER_POSITION], TIME_BASE_BITS);
  *entry->result = conversion_rate(entry->parameter[1], hal_signed(now - state->previous));
  *entry->first_result = now & HAL_WORD_MASK;
  state->previous = now;
}
