/* Entries made of other words: time base, filters, sums (motion:2). */
#include "firmware/motion/conversion_filter.h"

#include "firmware/hal/hal.h"
#include "firmware/motion/fixed_point.h"

enum { GAIN_BITS = 23, OUT_BITS = 8 };
#define INTEGRAL_MOST (INT64_C(1) << 54)

/* The first line's result holds the source as it was. */
void convert_time_base(const struct conversion_entry* entry) {
  struct conversion_state* state = entry->state;
  const uint32_t now = *entry->source[0];
  if (state->fresh) state->previous = now;
  state->fresh = false;
  *entry->result = conversion_rate(entry->parameter[1], hal_signed(now - state->previous));
  *entry->first_result = now & HAL_WORD_MASK;
  state->previous = now;
}

/* How far the result is behind the source, whose steps are limited to line 2; 2^-8 of the unit, the shorter way round.
 */
static int32_t behind(const struct conversion_entry* entry) {
  struct conversion_state* state = entry->state;
  const uint32_t now = *entry->source[0];
  const int32_t most = conversion_magnitude(entry, 1);
  if (state->fresh) {
    state->fresh = false;
    state->previous = now;
    state->out = (int32_t)(now << OUT_BITS);
  }
  const int32_t step = fixed_within(hal_signed(now - state->previous), most);
  state->previous += (uint32_t)step;
  return (int32_t)((state->previous << OUT_BITS) - (uint32_t)state->out);
}

/* `change` in 2^-23 of the unit of `out`; what is less than that is kept. */
static void move(const struct conversion_entry* entry, int64_t change) {
  struct conversion_state* state = entry->state;
  const int64_t all = change + state->remainder;
  state->out = (int32_t)((uint32_t)state->out + (uint32_t)(all >> GAIN_BITS));
  state->remainder = all & ((1 << GAIN_BITS) - 1);
  *entry->result = (uint32_t)state->out >> OUT_BITS;
}

void convert_exponential(const struct conversion_entry* entry) {
  move(entry, (int64_t)behind(entry) * conversion_magnitude(entry, 2));
}

/* Lines: most change, proportional gain, none, integral gain. */
void convert_tracking(const struct conversion_entry* entry) {
  struct conversion_state* state = entry->state;
  const int32_t error = behind(entry);
  const int64_t sum = state->integral + (int64_t)error * conversion_magnitude(entry, 4);
  const int64_t integral = fixed_within_long(sum, INTEGRAL_MOST);
  state->integral = integral;
  move(entry, (int64_t)error * conversion_magnitude(entry, 2) + integral);
}

/* Bits of the first line: first and second line number, then what is done with them. */
void convert_sum(const struct conversion_entry* entry) {
  enum { NEGATE_FIRST = 1 << 16, NEGATE_SECOND = 1 << 17, NO_SECOND = 1 << 18 };
  const uint32_t first = *entry->source[0], second = *entry->source[1], setup = entry->setup;
  uint32_t sum = (setup & NEGATE_FIRST) != 0u ? 0u - first : first;
  if ((setup & NO_SECOND) == 0u) sum += (setup & NEGATE_SECOND) != 0u ? 0u - second : second;
  if (entry->flag) {
    sum += entry->state->previous;
    entry->state->previous = sum;
  }
  *entry->result = sum & HAL_WORD_MASK;
}

void convert_nothing(const struct conversion_entry* entry) { *entry->result = 0; }
