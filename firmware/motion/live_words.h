/* Words of main memory that hold status, time base, timers and targets (firmware:1.10). They are made when they are
 * read and so never old; words.c asks through its table. */
#ifndef FIRMWARE_MOTION_LIVE_WORDS_H
#define FIRMWARE_MOTION_LIVE_WORDS_H

#include <stdbool.h>
#include <stdint.h>

bool live_word_read(bool x, uint32_t address, uint32_t* word); /* false: an ordinary word */
bool live_word_write(bool x, uint32_t address, uint32_t word); /* false: an ordinary word; else done, or not allowed */

#endif
