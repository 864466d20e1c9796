/* Entries made of other results; sources: X words. */
#ifndef FIRMWARE_MOTION_CONVERSION_FILTER_H
#define FIRMWARE_MOTION_CONVERSION_FILTER_H

#include "firmware/motion/conversion_entry.h"

void convert_time_base(const struct conversion_entry* entry);   /* $4 */
void convert_exponential(const struct conversion_entry* entry); /* $D */
void convert_tracking(const struct conversion_entry* entry);    /* $D, bit 19 */
void convert_sum(const struct conversion_entry* entry);         /* $E */
void convert_nothing(const struct conversion_entry* entry);     /* $F */

#endif
