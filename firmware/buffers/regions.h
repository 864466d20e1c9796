/* Memory manager of the user buffers (firmware:4.2). Regions lie in a fixed order, each directly above the one below
 * it, so a region can come or go only while nothing lives above it: fixed programs | CCBUF 16..1 | LOOKAHEAD 16..1 |
 * ROTARY 16..1 | GATHER | open memory up to $010800. Called by the background task only. */
#ifndef FIRMWARE_BUFFERS_REGIONS_H
#define FIRMWARE_BUFFERS_REGIONS_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/dimensions.h"
#include "firmware/base/error.h"

enum region_kind { REGION_CCBUF, REGION_LOOKAHEAD, REGION_ROTARY, REGION_GATHER, REGION_KINDS }; /* in memory order */

enum {
  CCBUF_WORDS_PER_MOVE = 10,     /* choice: no public figure */
  LOOKAHEAD_WORDS_MINIMUM = 6,   /* a segment: 2 a motor + 4, at least this (firmware:10/17) */
  LOOKAHEAD_WORDS_PER_OUTPUT = 2 /* a synchronous M-variable slot */
};

void regions_initialize(void);
error_t region_define(enum region_kind kind, uint32_t cs, uint32_t words); /* ERR003 order, ERR006 no room */
error_t region_delete(enum region_kind kind, uint32_t cs); /* ERR003 order; a missing region is no error */
error_t region_define_rest(void);                          /* GATHER over all open memory */
void region_delete_temporaries(void);                      /* GATHER, ROTARY, LOOKAHEAD, CCBUF of all C.S. */
uint32_t region_base(enum region_kind kind, uint32_t cs);  /* word offset in user memory */
uint32_t region_words(enum region_kind kind, uint32_t cs);
uint32_t region_open_words(void);            /* unused long words */
error_t region_resize_fixed(uint32_t words); /* fixed programs: ERR006 no room, ERR003 while something lies above */

#endif
