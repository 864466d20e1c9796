/* Structure of a stored program, read once before it is executed: from then on each jump is one look. It is read in the
 * task that executes the program, in slices if that is the real-time task; for PLC 0 in the background. Two tasks may
 * read one program at the same time: both write the same links, and none takes one away. */
#ifndef FIRMWARE_BUFFERS_PROGRAM_LINKS_H
#define FIRMWARE_BUFFERS_PROGRAM_LINKS_H

#include "firmware/buffers/fixed_programs.h"
#include "firmware/buffers/program_structure.h"

enum links { LINKS_MADE, LINKS_MOVED, LINKS_BAD }; /* programs have moved meanwhile: again; IF, WHILE do not fit */

enum links program_links_make(const struct fixed_program* program); /* at once if there are links already */
/* The line at the structure's offset; its words, 0 at the end or when programs have moved. `error`: what is
 * wrong with it. */
uint32_t program_links_line(struct program_structure* structure, const struct fixed_program* program, error_t* error);

#endif
