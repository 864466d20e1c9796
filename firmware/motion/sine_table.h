/* The sine table that users see (motion:3.2): 2048 long words from $003800, X cosine and Y sine in 2^-23, entry 0 at 0
 * degrees. Users may write it, or another one elsewhere that Ixx55 leads to. */
#ifndef FIRMWARE_MOTION_SINE_TABLE_H
#define FIRMWARE_MOTION_SINE_TABLE_H

#include <stdint.h>

enum { SINE_BITS = 11, SINE_ENTRIES = 1 << SINE_BITS };

void sine_table_initialize(void); /* start-up, after user memory has been cleared */
void sine_table_later(void);      /* a start: in the first pass of the background instead */
void sine_table_pass(void);

/* First address of the table of a motor whose Ixx55 is `offset`: a multiple of 2048. Where there is no memory for one,
 * the table of all. */
uint32_t sine_table_address(uint32_t offset);

#endif
