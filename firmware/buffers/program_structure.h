/* Whether IF, ELSE, ENDIF, WHILE and ENDWHILE of a program fit together (ERR009). */
#ifndef FIRMWARE_BUFFERS_PROGRAM_STRUCTURE_H
#define FIRMWARE_BUFFERS_PROGRAM_STRUCTURE_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/error.h"
#include "firmware/language/word.h"

enum { STRUCTURE_DEPTH = 32 }; /* blocks in each other; choice: no public figure */

struct program_structure {
  uint8_t blocks[STRUCTURE_DEPTH];
  uint32_t depth;
  bool else_may_follow;      /* the line before was a one-line IF */
  bool condition_may_follow; /* the statement before was a condition */
};

void program_structure_begin(struct program_structure* structure);
/* One stored line. In a motion program, what stands behind a condition on its line is all that it governs; a PLC has
 * a statement a line, and blocks only. ERR009: the structure stays as it was. */
error_t program_structure_line(struct program_structure* structure, bool motion, const word48_t* words, uint32_t count);

#endif
