/* The program line being entered. Its statements are compiled as they are met and stored together when the host line
 * has ended without an error; a change of the addressed coordinate system inside the line ends the program line of the
 * one before. */
#include "firmware/command/program_line.h"

#include "firmware/buffers/open_buffer.h"
#include "firmware/buffers/rotary.h"
#include "firmware/command/session.h"
#include "firmware/language/statement.h"

enum { LINE_WORDS = 300 }; /* a host line has at most 255 characters; a two-word constant takes two of them at least */

static struct {
  word48_t words[LINE_WORDS];
  uint32_t count;
  uint32_t cs;
} line;

bool program_buffer_open(void) { return open_buffer_kind() == OPEN_ROTARY; }

void program_line_begin(void) { line.count = 0; }

void program_line_abandon(void) { line.count = 0; }

error_t program_line_commit(void) {
  uint32_t count = line.count;
  line.count = 0;
  return count == 0 ? ERR_NONE : rotary_store(line.cs, line.words, count);
}

/* The pending line belongs to the addressed coordinate system, which needs a rotary buffer. */
static error_t address(void) {
  error_t error = ERR_NONE;
  if (line.count != 0 && line.cs != session.cs) error = program_line_commit();
  line.cs = session.cs;
  if (error == ERR_NONE && rotary_buffers[line.cs].size == 0) error = ERR_NO_ROOM;
  return error;
}

bool program_statement(struct lexer* lx, error_t* error) {
  const struct statement head = statement_find(lx);
  if (head.kind == STATEMENT_NONE) return false;
  *error = address();
  struct word_list list = {line.words, line.count,
                           LINE_WORDS}; /* a change of address has stored and emptied the line */
  if (*error == ERR_NONE) *error = statement_compile(lx, head, &list);
  if (*error == ERR_NONE) line.count = list.count;
  return true;
}
