/* PMAC words as users reach them, with R, W and M-variables. What does not exist on this board reads 0 and swallows
 * what is written. */
#ifndef FIRMWARE_VARIABLES_WORDS_H
#define FIRMWARE_VARIABLES_WORDS_H

#include <stdbool.h>
#include <stdint.h>

/* Words below `end` that higher layers make when they are read; false: an ordinary word. image/tables.c fills it in. */
struct word_hooks {
  uint32_t end;
  bool (*read)(bool x, uint32_t address, uint32_t* word);
  bool (*write)(bool x, uint32_t address, uint32_t word);
};
extern const struct word_hooks word_hooks;

bool word_exists(bool x, uint32_t address);
uint32_t word_read(bool x, uint32_t address);              /* 24 bits */
void word_write(bool x, uint32_t address, uint32_t value); /* the low 24 bits are stored */

#endif
