/* Memory manager of the user buffers (firmware:4.2). Fixed programs grow from $00A000 up, whatever else there is. The
 * regions lie in a fixed order from the top of memory down, each directly below the one before it, so a region can come
 * or go only while nothing lies below it: UBUFFER | COMP 32..1 | TCOMP 32..1 | BLCOMP 32..1 | TBUF | CCBUF 16..1 |
 * LOOKAHEAD 16..1 | ROTARY 16..1 | GATHER | open memory | fixed programs. Called by the background task only. */
#ifndef FIRMWARE_BUFFERS_REGIONS_H
#define FIRMWARE_BUFFERS_REGIONS_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/dimensions.h"
#include "firmware/base/error.h"

enum region_kind {              /* from the top down */
                   REGION_COMP, /* each motor's */
                   REGION_TCOMP,
                   REGION_BLCOMP,
                   REGION_TBUF,  /* one */
                   REGION_CCBUF, /* each coordinate system's */
                   REGION_LOOKAHEAD,
                   REGION_ROTARY,
                   REGION_GATHER, /* one */
                   REGION_KINDS
};

enum {
  TBUF_WORDS_PER_MATRIX = 12,    /* choice: three rows of three, and the displacement */
  CCBUF_WORDS_PER_MOVE = 10,     /* choice: no public figure */
  LOOKAHEAD_WORDS_MINIMUM = 6,   /* a segment: 2 a motor + 4, at least this (firmware:10/17) */
  LOOKAHEAD_WORDS_PER_OUTPUT = 2 /* a synchronous M-variable slot */
};

/* `owner`: motor or coordinate system; of one for all, any. */
void regions_initialize(void);
error_t region_define(enum region_kind kind, uint32_t owner, uint32_t words); /* ERR003 order, ERR006 no room */
error_t region_delete(enum region_kind kind, uint32_t owner); /* ERR003 order; a missing region is no error */
error_t region_define_rest(void);                             /* GATHER over all open memory */
void regions_delete_from(enum region_kind highest);           /* these and all below; CCBUF: the temporary ones */
uint32_t region_base(enum region_kind kind, uint32_t owner);  /* word offset in user memory */
uint32_t region_words(enum region_kind kind, uint32_t owner);
uint32_t region_open_words(void);            /* unused long words */
error_t region_resize_fixed(uint32_t words); /* fixed programs: ERR006 no room */
/* UBUFFER, at the top of memory: moves I4908. ERR003 while there is anything else, ERR006 no room; 0: none. */
error_t region_define_user(uint32_t words);
bool region_restore_user(uint32_t words); /* start-up, before other regions: beside the programs; false: no room */
uint32_t region_user_words(void);

#endif
