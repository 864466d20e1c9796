/* Commands from outside, as the binary rotary transfer brings them: which of them make a line that could have come as
 * text (host-bus:7.7). */
#ifndef FIRMWARE_LANGUAGE_BINARY_WORD_H
#define FIRMWARE_LANGUAGE_BINARY_WORD_H

#include "firmware/language/word.h"

/* Error codes of host-bus:7.5. */
enum binary_fault { BINARY_GOOD = 0, BINARY_CODE = 5, BINARY_ARGUMENT = 6, BINARY_INCOMPLETE = 8 };

/* What the commands so far leave open; all zero where a line begins. */
struct binary_judge {
  bool begun, called, prefixed;
  uint32_t axis; /* of the command before, counted from 1; 0: that was no axis */
};

enum binary_fault binary_judge_word(struct binary_judge* judge, word48_t word);
enum binary_fault binary_judge_end(const struct binary_judge* judge);

#endif
