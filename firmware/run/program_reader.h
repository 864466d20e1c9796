/* Where the words of a program come from: the ring of a rotary buffer, whose words are free when they have been read,
 * or a fixed program, in which the position can be set. A position in a fixed program is an offset from its beginning:
 * programs may be moved in memory by the background while the real-time task executes one. */
#ifndef FIRMWARE_RUN_PROGRAM_READER_H
#define FIRMWARE_RUN_PROGRAM_READER_H

#include "firmware/buffers/fixed_programs.h"
#include "firmware/buffers/program_structure.h"

enum reader_result {
  READER_WORD,
  READER_LATER, /* the ring is empty, or programs are being moved: ask again at the next interrupt or pass */
  READER_END,   /* behind the last word of a fixed program */
  READER_BAD    /* it is not there any more, or its blocks do not fit together */
};

struct program_reader {
  bool rotary;
  uint16_t kind;   /* enum fixed_kind */
  uint32_t number; /* of the program; of the coordinate system: rotary and kinematic programs */
  uint32_t offset; /* of the next word. Rotary: see reader_offset */
  /* fixed: where it was at the last look */
  uint32_t base, words, generation;
};

void reader_rotary(struct program_reader* reader, uint32_t cs);
void reader_fixed(struct program_reader* reader, enum fixed_kind kind, uint32_t number, uint32_t offset);
enum reader_result reader_check(enum fixed_kind kind, uint32_t number); /* can it be executed? BAD or LATER: no */
enum reader_result reader_peek(struct program_reader* reader, uint32_t ahead, word48_t* word);
bool reader_advance(struct program_reader* reader,
                    uint32_t count);                  /* behind words that were seen; true: a line's end */
void reader_skip_line(struct program_reader* reader); /* the rest of the line that stands at a word behind its first */
uint32_t reader_offset(const struct program_reader* reader);
uint32_t reader_link(const struct program_reader* reader, uint32_t offset); /* program_structure.h */

#endif
