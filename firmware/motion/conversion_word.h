/* Entries that read words; sources: a Y word, and of a parallel one what follows it. */
#ifndef FIRMWARE_MOTION_CONVERSION_WORD_H
#define FIRMWARE_MOTION_CONVERSION_WORD_H

#include "firmware/motion/conversion_entry.h"

void convert_analog(const struct conversion_entry* entry);            /* $1 */
void convert_analog_integrated(const struct conversion_entry* entry); /* $5 */
void convert_parallel(const struct conversion_entry* entry);          /* $2 and $6 */
void convert_parallel_limited(const struct conversion_entry* entry);  /* $3 and $7 */

#endif
