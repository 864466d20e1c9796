/* Entries that read words as they stand: ADC registers and parallel words (motion:2). */
#include "firmware/motion/conversion_word.h"

#include "firmware/hal/hal.h"
#include "firmware/motion/fixed_point.h"

enum { ADC_SHIFT = 3, ADC_BITS = 0xFFFF00 };

/* The upper 16 bits of a word, lowest in bit 8. */
static int32_t analog(const struct conversion_entry* entry) {
  const uint32_t word = *entry->source[0] & ADC_BITS;
  return entry->flag ? (int32_t)word : hal_signed(word);
}

void convert_analog(const struct conversion_entry* entry) {
  *entry->result = (uint32_t)(analog(entry) >> ADC_SHIFT) & HAL_WORD_MASK;
}

void convert_analog_integrated(const struct conversion_entry* entry) {
  int32_t value = analog(entry) - entry->parameter[1];
  if (entry->flag && value < 0) value = 0;
  entry->state->previous += (uint32_t)value; /* with the bits that the result has not */
  *entry->result = entry->state->previous >> ADC_SHIFT & HAL_WORD_MASK;
}

/* A number of 48 bits, source[1] being the upper half; it is read only where the bits reach into it. */
static uint32_t parallel(const struct conversion_entry* entry) {
  const unsigned least = entry->least, width = entry->width;
  uint32_t bits = 0;
  if (least < 24u) bits = *entry->source[0] >> least;
  if (least + width > 24u)
    bits |= least < 24u ? *entry->source[1] << (24u - least) : *entry->source[1] >> (least - 24u);
  return bits & ((1u << width) - 1u);
}

/* How far it has moved, the shorter way round. */
static int32_t moved(const struct conversion_entry* entry, uint32_t now, uint32_t before) {
  const unsigned beside = 32u - entry->width;
  return (int32_t)((now - before) << beside) >> beside;
}

/* The result goes on where the source rolls over: it is the sum of all movement. `out` has it, `previous` the source.
 */
static void follow(const struct conversion_entry* entry, int32_t most) {
  struct conversion_state* state = entry->state;
  const uint32_t now = parallel(entry);
  if (state->fresh) {
    state->fresh = false;
    state->previous = now;
    state->out = (int32_t)(now << entry->shift);
  }
  const int32_t step = fixed_within(moved(entry, now, state->previous), most);
  state->previous += (uint32_t)step;
  state->out = (int32_t)((uint32_t)state->out + ((uint32_t)step << entry->shift));
  *entry->result = (uint32_t)state->out & HAL_WORD_MASK;
}

void convert_parallel(const struct conversion_entry* entry) { follow(entry, INT32_MAX); }
void convert_parallel_limited(const struct conversion_entry* entry) { follow(entry, conversion_magnitude(entry, 2)); }
