/* Fixed programs: motion programs, PLCs and kinematic programs (firmware:4.1), one above the other from the bottom of
 * user memory. The open one is always the topmost, so that a line is stored in the time of its words whatever there is.
 * Written by the background task. Who reads in the real-time task looks at fixed_programs_generation before and after.
 */
#ifndef FIRMWARE_BUFFERS_FIXED_PROGRAMS_H
#define FIRMWARE_BUFFERS_FIXED_PROGRAMS_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/error.h"
#include "firmware/language/word.h"

enum fixed_kind { FIXED_PROG, FIXED_PLC, FIXED_FORWARD, FIXED_INVERSE, FIXED_KINDS };

enum {
  FIXED_PROG_LIMIT = 32767,  /* highest number */
  FIXED_PROG_COUNT = 224,    /* as many of them */
  FIXED_PLC_COUNT = 32,      /* 0 to 31 */
  FIXED_PROGRAMS_COUNT = 288 /* with the two kinematic ones of each coordinate system */
};

struct fixed_program {
  uint16_t kind, number; /* number: of PROG or PLC, or coordinate system from 0 */
  uint32_t base, words;
  bool linked; /* program_links_make has been there since it was opened last */
};

void fixed_programs_initialize(void);
uint32_t fixed_programs_count(void);
const struct fixed_program* fixed_program_at(uint32_t index);                          /* in memory order */
const struct fixed_program* fixed_program_find(enum fixed_kind kind, uint32_t number); /* 0: there is none */
word48_t fixed_program_word(const struct fixed_program* program, uint32_t offset);
/* Words of the line that begins at `offset`, its raw words with it; 0 at the end. */
uint32_t fixed_program_line(const struct fixed_program* program, uint32_t offset);

/* Odd while programs are being moved: the real-time task executes none then. Another even number: they may lie
 * elsewhere. */
uint32_t fixed_programs_generation(void);
/* Where execution goes on (program_structure.h), a link a word of user memory; they move with their program. Cleared
 * where words are stored, written by whichever task executes them. */
extern uint16_t fixed_program_links[];
void fixed_program_set_linked(const struct fixed_program* program);

/* The open program. */
error_t fixed_program_open(enum fixed_kind kind, uint32_t number); /* ERR006: no more programs */
const struct fixed_program* fixed_program_opened(void);            /* 0: none */
error_t fixed_program_append(const word48_t* words, uint32_t count);
void fixed_program_drop_last(void); /* its last word */
void fixed_program_clear(void);
void fixed_program_close(void); /* an empty one is gone; one is open */

/* Erases all programs of these kinds, a bit each; none is open. */
void fixed_programs_erase(uint32_t kinds);

/* Enters a program whose words are in user memory already, above all other programs. False: it does not fit. */
bool fixed_program_restore(enum fixed_kind kind, uint32_t number, uint32_t words);

#endif
