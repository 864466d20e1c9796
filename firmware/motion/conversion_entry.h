/* One entry of the encoder conversion table, ready for the servo task: what it reads, where its result goes and what it
 * remembers from one servo interrupt to the next. Results are 24-bit words that wrap, 1/32 count. */
#ifndef FIRMWARE_MOTION_CONVERSION_ENTRY_H
#define FIRMWARE_MOTION_CONVERSION_ENTRY_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/hal/hal.h"

enum { CONVERSION_LINES = 192, CONVERSION_LONGEST = 5, CONVERSION_SOURCES = 5 };

/* All zero but for what conversion_table.c says, when an entry begins. */
struct conversion_state {
  bool fresh; /* nothing remembered yet */
  bool runs;  /* a triggered time base that has had its trigger */
  uint32_t previous;
  int32_t out;       /* of a filter: 2^-8 of the result's unit */
  int64_t remainder; /* what `out` has lost in rounding, 2^-23 of its unit */
  int64_t integral;
};

struct conversion_entry {
  void (*convert)(const struct conversion_entry* entry); /* 0: conversion_software_1t */
  const volatile uint32_t* source[CONVERSION_SOURCES];
  volatile uint32_t *first_result, *result; /* X of its first and of its last line */
  struct conversion_state* state;
  bool flag; /* bit 19 of the first line */
  uint8_t line, method;
  uint8_t shift, width, least;           /* of a parallel word: of its result, then where it stands in 48 bits */
  uint32_t setup;                        /* the first line */
  int32_t parameter[CONVERSION_LONGEST]; /* the others, [1] is line 2 */
};

/* A line that has no sign: the most that a source may change, the gain of a filter. */
static inline int32_t conversion_magnitude(const struct conversion_entry* entry, uint32_t line) {
  return (int32_t)((uint32_t)entry->parameter[line] & HAL_WORD_MASK);
}

/* 2 x factor x movement, of a time base: one that is too fast for the word is at its end, and does not turn round. */
static inline uint32_t conversion_rate(int32_t factor, int32_t movement) {
  const int64_t rate = 2 * (int64_t)factor * movement, most = HAL_WORD_MASK >> 1;
  return (uint32_t)(rate > most ? most : rate < -most ? -most : rate) & HAL_WORD_MASK;
}

#endif
