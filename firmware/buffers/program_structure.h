/* Whether IF, ELSE, ENDIF, WHILE and ENDWHILE of a program fit together (ERR009), and where each of them leads to. */
#ifndef FIRMWARE_BUFFERS_PROGRAM_STRUCTURE_H
#define FIRMWARE_BUFFERS_PROGRAM_STRUCTURE_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/error.h"
#include "firmware/language/word.h"

enum { STRUCTURE_DEPTH = 32 }; /* blocks in each other; choice: no public figure */

/* Links, one for each word of a program: where the execution goes on when the word does not simply lead to the next.
 *   condition that AND(..) or OR(..) continues   LINK_CONTINUES
 *   condition of a block                         behind its ELSE, ENDIF or ENDWHILE, when it is false
 *   ELSE of a block                              behind its ENDIF
 *   ENDWHILE                                     one more than where the condition of its WHILE begins */
enum { LINK_NONE = 0, LINK_CONTINUES = 0xFFFF };

struct program_structure {
  struct {
    uint8_t kind;
    uint16_t from, at; /* where its statement begins; the word that gets the link */
  } blocks[STRUCTURE_DEPTH];
  uint32_t depth;
  uint32_t offset;           /* of the next line */
  uint32_t condition;        /* word of the last condition */
  bool condition_opened;     /* a block */
  uint16_t* links;           /* of the program, written when not 0 */
  bool else_may_follow;      /* the line before was a one-line IF */
  bool condition_may_follow; /* the statement before was a condition */
  bool returns;              /* the last statement is RETURN */
};

/* `links`: 0 while lines are entered. */
void program_structure_begin(struct program_structure* structure, uint16_t* links);
/* One stored line. In a motion program, what stands behind a condition on its line is all that it governs; a PLC has
 * a statement a line, and blocks only. ERR009: the structure stays as it was. */
error_t program_structure_line(struct program_structure* structure, bool motion, const word48_t* words, uint32_t count);

#endif
