/* Words of main memory that hold status, time base, timers and targets (firmware:1.10). They are made when they are
 * read and so never old; words.c asks through its table. */
#ifndef FIRMWARE_MOTION_LIVE_WORDS_H
#define FIRMWARE_MOTION_LIVE_WORDS_H

#include <stdbool.h>
#include <stdint.h>

bool live_word_read(uint32_t address, uint32_t* x, uint32_t* y); /* replaces the halves that are made; false: none */
/* Bits of `mask`. False: an ordinary word; else done, or not allowed. */
bool live_word_write(bool x, uint32_t address, uint32_t mask, uint32_t bits);
bool live_word_write_long(uint32_t address, uint32_t x, uint32_t y); /* a position, in one piece; false: none */

#endif
