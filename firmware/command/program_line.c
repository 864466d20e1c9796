/* The program line being entered. Its statements are compiled as they are met and stored together when the host line
 * has ended without an error; a change of the addressed coordinate system inside the line ends the program line of the
 * one before. PLCs and kinematic programs have a program line for each statement. */
#include "firmware/command/program_line.h"

#include "firmware/buffers/fixed_entry.h"
#include "firmware/buffers/open_buffer.h"
#include "firmware/buffers/rotary.h"
#include "firmware/command/session.h"
#include "firmware/language/axis_constant.h"
#include "firmware/language/statement.h"

enum { LINE_WORDS = 300 }; /* a host line has at most 255 characters; a two-word constant takes two of them at least */

static struct {
  word48_t words[LINE_WORDS];
  uint32_t count;
  uint32_t cs;
  bool called;       /* a statement of the line is a call */
  uint32_t where;    /* what was open when words were compiled ahead */
  const char* ahead; /* where that stopped in the text; 0: nothing was */
  const char* from;  /* where it began */
  const char* text;  /* of the host line, its beginning */
} line;

/* Kind of the open program for the statement table; 0: nothing takes text of this port. */
static uint32_t open_where(void) {
  static const uint8_t fixed[FIXED_KINDS] = {WHERE_PROG, WHERE_PLC, WHERE_KINEMATIC, WHERE_KINEMATIC};
  if (!session_owns_buffer()) return 0;
  if (open_buffer_kind() == OPEN_ROTARY) return WHERE_ROTARY;
  return open_buffer_kind() == OPEN_FIXED ? fixed[fixed_program_opened()->kind] : 0;
}

bool program_buffer_open(void) { return open_where() != 0; }

static void empty(void) {
  line.count = 0;
  line.called = false;
}

void program_line_forget_ahead(void) { line.ahead = 0; }

static bool takes_axes(uint32_t where) {
  if ((where & WHERE_ROTARY) != 0) return rotary_buffers[session.cs].size != 0;
  return (where & WHERE_MOVES) != 0;
}

void program_line_ahead(const char* text, const char* boundary) {
  const uint32_t where = open_where();
  if (!takes_axes(where)) return;
  if (line.ahead == 0) {
    empty();
    line.ahead = line.from = text;
    line.where = where;
    line.cs = session.cs;
  }
  line.count += axis_constants(&line.ahead, boundary, line.words + line.count, LINE_WORDS - line.count);
}

/* What was compiled ahead is of the line that comes, not of a control character's command inside it (^U): that forgets
 * it, and the rest of the line begins anew. */
const char* program_line_begin(const char* text) {
  line.text = text;
  const char* const ahead = line.ahead;
  line.ahead = 0;
  if (ahead != 0 && line.from == text && line.where == open_where() && line.cs == session.cs) return ahead;
  empty();
  return text;
}

void program_line_abandon(void) { empty(); }

/* Of the whole host line. */
static uint32_t characters(void) {
  uint32_t count = 0;
  while (line.text[count] != '\0') count++;
  return count;
}

error_t program_line_commit(void) {
  uint32_t count = line.count;
  empty();
  if (count == 0) return ERR_NONE;
  return open_buffer_kind() == OPEN_FIXED ? fixed_entry_store(line.words, count, characters())
                                          : rotary_store(line.cs, line.words, count);
}

/* The pending line of a rotary buffer belongs to the addressed coordinate system, which needs one. */
static error_t address(void) {
  error_t error = ERR_NONE;
  if (line.count != 0 && line.cs != session.cs) error = program_line_commit();
  line.cs = session.cs;
  if (error == ERR_NONE && rotary_buffers[line.cs].size == 0) error = ERR_NO_ROOM;
  return error;
}

bool program_statement(struct lexer* lx, error_t* error) {
  uint32_t where = open_where();
  if (where == 0) return false;
  if (takes_axes(where) && (line.count == 0 || line.cs == session.cs)) {
    const uint32_t made = axis_constants(&lx->at, 0, line.words + line.count, LINE_WORDS - line.count);
    line.cs = session.cs;
    line.count += made;
    *error = ERR_NONE;
    if (made != 0) return true;
  }
  const bool one_a_line = (where & WHERE_MOVES) == 0;
  if (line.count != 0 && !one_a_line) where |= WHERE_BEGUN;
  if (line.called) where |= WHERE_CALLED;
  const struct statement head = statement_find(lx, where);
  if (head.kind == STATEMENT_NONE) return false;
  *error = (where & WHERE_ROTARY) != 0 ? address() : ERR_NONE;
  struct word_list list = {line.words, line.count,
                           LINE_WORDS}; /* a change of address has stored and emptied the line */
  if (*error == ERR_NONE) *error = statement_compile(lx, head, where, &list);
  if (*error != ERR_NONE) return true;
  if (one_a_line) line.words[line.count] |= WORD_START_OF_LINE;
  if (head.kind == STATEMENT_ROW && (statement_rows[head.index].where & CALLS) != 0) line.called = true;
  line.count = list.count;
  return true;
}
