/* Program words back to text, such that the text is compiled to the same words (firmware:4.8). */
#ifndef FIRMWARE_LANGUAGE_LISTER_H
#define FIRMWARE_LANGUAGE_LISTER_H

#include "firmware/language/word.h"

/* One line. `long_form`: keywords in full, if that is no longer than a line may be. Damaged words are shown as `?`.
 * Background task. */
void lister_line(const word48_t* words, uint32_t count, bool long_form, void (*put)(char c));
uint32_t lister_length(const word48_t* words, uint32_t count); /* characters of the short form */

#endif
