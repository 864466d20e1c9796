/* Entries that read an encoder channel; sources: X:+2, Y:+0, Y:+1, X:+0 and X:+3 of it. */
#ifndef FIRMWARE_MOTION_CONVERSION_ENCODER_H
#define FIRMWARE_MOTION_CONVERSION_ENCODER_H

#include "firmware/hal/hal.h"
#include "firmware/motion/conversion_entry.h"

enum { ENCODER_POSITION, ENCODER_BETWEEN, ENCODER_SINCE, ENCODER_STATUS, ENCODER_CAPTURED }; /* sources */
enum { CONVERSION_FRACTION = 5 };                                                            /* bits of a count */

/* Counts with a fraction of `bits` bits. The time since the last count, as part of the time between the last two, goes
 * on the way that the counter moves; after a turn, or when the encoder has become slower, nothing is known. */
static inline uint32_t conversion_with_time(const struct conversion_entry* entry, uint32_t position, unsigned bits) {
  const uint32_t turned = 1u << 23, down = 1u, counts = (position >> 1) << bits;
  const uint32_t between = *entry->source[ENCODER_BETWEEN], since = *entry->source[ENCODER_SINCE];
  if (since > between || between - 1u >= turned - 1u) return counts; /* turned, or no time */
  const uint32_t all = (1u << bits) - 1u, part = since == between ? all : (since << bits) / between;
  return (position & down) != 0u ? counts - part : counts + part;
}

static inline void conversion_software_1t(const struct conversion_entry* entry) {
  *entry->result = conversion_with_time(entry, *entry->source[ENCODER_POSITION], CONVERSION_FRACTION) & HAL_WORD_MASK;
}

void convert_sub_count(const struct conversion_entry* entry);   /* $8 */
void convert_counter(const struct conversion_entry* entry);     /* $C */
void convert_hardware_1t(const struct conversion_entry* entry); /* $C, bit 19 */
void convert_frozen(const struct conversion_entry* entry);      /* $9 */
void convert_armed(const struct conversion_entry* entry);       /* $B, and $A when the trigger has come */

#endif
