/* DISPLAY of programs: the text of a display of two lines of 40 characters, which no board here has. It is kept where
 * clients look for it, one character a word from Y:$1080 on; X:$24 says so (firmware:7.2). Any task. */
#ifndef FIRMWARE_RUN_DISPLAY_H
#define FIRMWARE_RUN_DISPLAY_H

#include <stdint.h>

void display_initialize(void);                                        /* blank. User memory is there */
void display_text(uint32_t column, const char* text, uint32_t count); /* what goes beyond the last column is lost */
/* Right-aligned in `width`; a number that is wider fills it with `*`. */
void display_value(uint32_t column, uint32_t width, uint32_t decimals, double value);

#endif
