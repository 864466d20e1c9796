/* PMAC words as users reach them, with R, W and M-variables. What does not exist on this board reads 0 and swallows
 * what is written. */
#ifndef FIRMWARE_VARIABLES_WORDS_H
#define FIRMWARE_VARIABLES_WORDS_H

#include <stdbool.h>
#include <stdint.h>

/* Words below `end` that higher layers make when they are read; image/tables.c fills it in. No task is held off while
 * they are called: what they take from other tasks they fetch under a mask of their own. */
struct word_hooks {
  uint32_t end;
  bool (*read)(uint32_t address, uint32_t* x, uint32_t* y);              /* replaces the halves that it makes, if any */
  bool (*write)(bool x, uint32_t address, uint32_t mask, uint32_t bits); /* false: an ordinary word */
  bool (*write_long)(uint32_t address, uint32_t x, uint32_t y);          /* both at one moment; false: one by one */
};
extern const struct word_hooks word_hooks;

bool word_exists(bool x, uint32_t address);
bool word_is_plain(uint32_t address);         /* of main memory, and nobody makes it: it may be read where it stands */
uint32_t word_read(bool x, uint32_t address); /* 24 bits */
void word_read_long(uint32_t address, uint32_t* x, uint32_t* y);              /* both of one moment */
void word_write(bool x, uint32_t address, uint32_t value);                    /* the low 24 bits are stored */
void word_write_long(uint32_t address, uint32_t x, uint32_t y);               /* both at one moment */
void word_write_part(bool x, uint32_t address, uint32_t mask, uint32_t bits); /* only the bits of `mask` */

#endif
