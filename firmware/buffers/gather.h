/* Data gathering (firmware:4.3, host-bus:6.8): at every I5049th servo interrupt the words that I5050 and I5051 choose
 * of I5001..I5048 go to a buffer in user memory or in the dual-ported RAM, by I5000. Commands are of the background
 * task. */
#ifndef FIRMWARE_BUFFERS_GATHER_H
#define FIRMWARE_BUFFERS_GATHER_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/error.h"

enum { GATHER_ALL_THERE_IS = 0 };

void gather_initialize(void);
error_t gather_define(uint32_t words); /* again: the buffer there is, from its beginning. ERR003 while it gathers */
error_t gather_delete(void);           /* ERR003 while it gathers */
void gather_delete_always(void);       /* the memory manager takes its words away */
error_t gather_begin(void);            /* ERR003 without a buffer, without room, without a source */
void gather_end(void);
uint32_t gather_stored_words(void); /* long words in user memory that can be listed; 0 in the other */
void gather_servo(void);            /* servo task */
void gather_report_sources(void (*put)(uint8_t byte)); /* ^E: 24 bits in three bytes, the highest first; X before Y */

#endif
