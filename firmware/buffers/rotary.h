/* Rotary buffers: one ring of program words per coordinate system in user memory (firmware:4.5). The background task
 * stores whole lines, the real-time task reads words; a line's words are free again as soon as they have been
 * calculated. */
#ifndef FIRMWARE_BUFFERS_ROTARY_H
#define FIRMWARE_BUFFERS_ROTARY_H

#include "firmware/base/error.h"
#include "firmware/buffers/rotary_ring.h"
#include "firmware/language/word.h"

void rotary_initialize(void);
error_t rotary_define(uint32_t cs, uint32_t words);
error_t rotary_delete(uint32_t cs);
void rotary_delete_all(void);
bool rotary_any(void);
void rotary_clear(uint32_t cs);
error_t rotary_store(uint32_t cs, const word48_t* words,
                     uint32_t count); /* one line; the first word gets its mark here */

/* The same in parts, by whoever fills binary buffers: words into free space, which only grows, then all at once. */
uint32_t rotary_room(uint32_t cs); /* free words; none while it is held */
void rotary_put(uint32_t cs, uint32_t ahead, word48_t word);
void rotary_publish(uint32_t cs, uint32_t count);
void rotary_hold(bool held); /* background: nothing is stored while it looks at lines */

/* Background. The lines whose calculation has not begun. They stay where they are, calculated meanwhile or not, until
 * the background stores again. */
struct rotary_lines {
  uint32_t offset, words; /* of the first one; of all */
};
struct rotary_lines rotary_lines_ahead(uint32_t cs);
uint32_t rotary_offset(uint32_t cs, uint32_t offset, uint32_t ahead); /* `ahead` words behind `offset` */
word48_t rotary_word(uint32_t cs, uint32_t offset);

/* Real-time task. */
bool rotary_peek(uint32_t cs, uint32_t ahead, word48_t* word); /* word `ahead` of the read pointer, if stored */
bool rotary_consume(uint32_t cs, uint32_t count); /* true: that was the end of a line, PR and BREQ are updated */
void rotary_skip_line_rest(uint32_t cs);          /* to the next line start: the line's begun calculation is lost */

#endif
