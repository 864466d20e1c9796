/* PMAC words as users reach them, with R, W and M-variables. What does not exist on this board reads 0 and swallows
 * what is written. */
#ifndef FIRMWARE_VARIABLES_WORDS_H
#define FIRMWARE_VARIABLES_WORDS_H

#include <stdbool.h>
#include <stdint.h>

bool word_exists(bool x, uint32_t address);
uint32_t word_read(bool x, uint32_t address);              /* 24 bits */
void word_write(bool x, uint32_t address, uint32_t value); /* the low 24 bits are stored */

#endif
