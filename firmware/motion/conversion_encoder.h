/* Entries that read an encoder channel; sources: X:+2, Y:+0, Y:+1, X:+0 and X:+3 of it. */
#ifndef FIRMWARE_MOTION_CONVERSION_ENCODER_H
#define FIRMWARE_MOTION_CONVERSION_ENCODER_H

#include "firmware/motion/conversion_entry.h"

void convert_software_1t(const struct conversion_entry* entry); /* $0 */
void convert_sub_count(const struct conversion_entry* entry);   /* $8 */
void convert_counter(const struct conversion_entry* entry);     /* $C */
void convert_hardware_1t(const struct conversion_entry* entry); /* $C, bit 19 */
void convert_frozen(const struct conversion_entry* entry);      /* $9 */
void convert_armed(const struct conversion_entry* entry);       /* $B, and $A when the trigger has come */

#endif
