/* Labels, jumps and calls of motion programs (firmware:7.2, firmware:7.3): GOTO, GOSUB, CALL, the letter codes G M T D,
 * READ and the way back. Real-time task, in slices; the search for a label in the background too. */
#ifndef FIRMWARE_RUN_CALLS_H
#define FIRMWARE_RUN_CALLS_H

#include "firmware/run/motion_program.h"

bool calls_is_call(const struct instruction* in); /* what stands before it on its line has to be done first */
/* Executes it. STATEMENT: it is none of these. ERROR: no such program or label, or too many calls in each other. */
enum executed calls_execute(struct motion_program* p, const struct instruction* in);
/* PRELUDE (motion:8.4): before a line that begins with a move, behind its labels if it has any, comes the call. */
bool calls_prelude_is_due(struct motion_program* p);
enum executed calls_prelude_call(struct motion_program* p); /* LINE; LATER, ERROR as of a call */
void calls_note_label(struct motion_program* p, enum executed executed, const struct instruction* in);
bool calls_return(struct motion_program* p); /* false: nothing has called it */

/* Where label N or O stands in a program, its top for 0. END, BAD: there is no such program or label. LATER: programs
 * are being moved, which no background sees. */
enum reader_result calls_find(uint32_t program, uint32_t label, struct program_entry* entry);
/* B{n}, CALL n: program and label of 3.025, which is label 2500 of program 3. False: out of range. */
bool calls_split(double value, uint32_t* program, uint32_t* label);

#endif
