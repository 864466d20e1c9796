/* Entries that read an encoder channel of a servo IC: counter, fraction of a count by time or by the IC, triggered time
 * base (motion:2, servo-ic:2.2 to servo-ic:2.4). The IC latches all of it at the servo clock. */
#include "firmware/motion/conversion_encoder.h"

#include "firmware/hal/hal.h"
#include "rtl/regs/brick_regs.h"

enum { POSITION, BETWEEN, SINCE, STATUS, CAPTURED };
enum { FRACTION_BITS = 5, TIME_BASE_BITS = 8 };

static const uint32_t TURNED = 1u << 23, DOWN = 1u, CAPTURE = SERVO_CHANNEL_STATUS_CAPTURED_MASK;

/* Counts with a fraction of `bits` bits. The time since the last count, as part of the time between the last two, goes
 * on the way that the counter moves; after a turn, or when the encoder has become slower, nothing is known. */
static uint32_t with_time(const struct conversion_entry* entry, uint32_t position, unsigned bits) {
  const uint32_t counts = (position >> 1) << bits;
  const uint32_t between = *entry->source[BETWEEN], since = *entry->source[SINCE];
  if (since > between || between - 1u >= TURNED - 1u) return counts; /* turned, or no time */
  const uint32_t all = (1u << bits) - 1u, part = since == between ? all : (since << bits) / between;
  return (position & DOWN) != 0u ? counts - part : counts + part;
}

void convert_software_1t(const struct conversion_entry* entry) {
  *entry->result = with_time(entry, *entry->source[POSITION], FRACTION_BITS) & HAL_WORD_MASK;
}

/* The IC's fraction counts upwards in both directions. */
void convert_hardware_1t(const struct conversion_entry* entry) {
  const uint32_t counts = (*entry->source[POSITION] >> 1) << FRACTION_BITS;
  *entry->result = (counts | *entry->source[SINCE] >> (24 - FRACTION_BITS)) & HAL_WORD_MASK;
}

void convert_counter(const struct conversion_entry* entry) {
  *entry->result = ((*entry->source[POSITION] >> 1) << FRACTION_BITS) & HAL_WORD_MASK;
}

/* Bits 23 to 19 of the status word: T, U, V, W, USER. */
void convert_sub_count(const struct conversion_entry* entry) {
  const uint32_t counts = (*entry->source[POSITION] >> 1) << FRACTION_BITS;
  *entry->result = (counts | *entry->source[STATUS] >> (24 - FRACTION_BITS)) & HAL_WORD_MASK;
}

/* Reading the captured position arms the trigger. */
void convert_frozen(const struct conversion_entry* entry) {
  (void)*entry->source[CAPTURED];
  *entry->result = 0;
}

/* From the captured position on when the trigger comes, with the first distance in the same interrupt. */
void convert_armed(const struct conversion_entry* entry) {
  struct conversion_state* state = entry->state;
  if (!state->runs) {
    *entry->result = 0;
    if ((*entry->source[STATUS] & CAPTURE) == 0u) return;
    state->runs = true;
    state->previous = *entry->source[CAPTURED] << TIME_BASE_BITS;
  }
  const uint32_t now = with_time(entry, *entry->source[POSITION], TIME_BASE_BITS);
  *entry->result = (uint32_t)(2 * entry->parameter[1]) * (uint32_t)hal_signed(now - state->previous) & HAL_WORD_MASK;
  *entry->first_result = now & HAL_WORD_MASK;
  state->previous = now;
}
