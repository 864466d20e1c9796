/* The program line being entered: what the command interpreter calls while a buffer is open. */
#ifndef FIRMWARE_COMMAND_PROGRAM_LINE_H
#define FIRMWARE_COMMAND_PROGRAM_LINE_H

#include "firmware/language/lexer.h"

bool program_buffer_open(void); /* some buffer is open for ASCII entry */
/* Before the first command of each host line: where to begin, `text` or what of it has been compiled ahead. */
const char* program_line_begin(const char* text);
/* Background: compiles what can be compiled of a line that is still coming, up to the letter at `boundary`. Nothing is
 * stored and nothing else changed; until program_line_begin gets the same `text` that may only grow. */
void program_line_ahead(const char* text, const char* boundary);
void program_line_forget_ahead(void); /* another line, or another text of it */
/* Compiles one statement into the pending line; false: no buffer is open, or lx stands before something else. */
bool program_statement(struct lexer* lx, error_t* error);
error_t program_line_commit(void); /* at the end of the host line: stores the pending statements as one program line */
void program_line_abandon(void);   /* after an error: nothing of the line is stored */

#endif
