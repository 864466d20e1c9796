#include "firmware/buffers/fixed_entry.h"

#include "firmware/buffers/buffer_request.h"
#include "firmware/buffers/program_links.h"
#include "firmware/language/lexer.h"
#include "firmware/language/lister.h"
#include "firmware/language/statement_key.h"

/* A word is listed with so many characters more than it took at most: the 0 of `0.5`, a blank behind `RET`, those
 * around an inner AND or OR, the decimals of `DISPLAY1,8.0,P1`, brackets in `-(-5)`. */
enum { LISTED_MORE = 2 };

static struct program_structure structure;

static bool is_motion(void) { return fixed_program_opened()->kind == FIXED_PROG; }

/* A program that is added to: what its lines have opened is open. Damaged ones are taken as they are. */
static void read_structure(void) {
  error_t error;
  program_structure_begin(&structure, 0);
  while (program_links_line(&structure, fixed_program_opened(), &error) != 0) {}
}

/* RETURN as CLOSE appends it. Its value is not listed: it tells this one from a RETURN of the lines, which stays. */
static word48_t closing_return(void) {
  const struct instruction in = {OP_STATEMENT, 0, KEY_RETURN, 1.0};
  return word_encode(&in) | WORD_START_OF_LINE;
}

static void append_return(void) {
  const word48_t word = closing_return();
  if (fixed_program_opened()->words == 0 || structure.depth != 0 || structure.returns) return;
  (void)fixed_program_append(&word, 1); /* without room for it the program ends there all the same */
}

static void remove_return(void) {
  const struct fixed_program* program = fixed_program_opened();
  if (program->words != 0 && fixed_program_word(program, program->words - 1u) == closing_return())
    fixed_program_drop_last();
}

error_t fixed_entry_begin(enum fixed_kind kind, uint32_t number) {
  const error_t error = fixed_program_open(kind, number);
  if (error != ERR_NONE) return error;
  remove_return();
  read_structure();
  buffer_request_fixed_opened();
  return ERR_NONE;
}

static uint32_t line_end(const word48_t* words, uint32_t first, uint32_t count) {
  uint32_t at = first;
  do {
    const struct instruction in = word_decode(words[at]);
    at += 1u + word_raw_count(&in);
  } while (at < count && (words[at] & WORD_START_OF_LINE) == 0);
  return at < count ? at : count;
}

/* A listing is to be downloaded again, so it may be no longer than a line. That takes long to measure. */
static bool can_be_listed(const word48_t* words, uint32_t count, uint32_t characters) {
  return characters + LISTED_MORE * count <= LEXER_LINE_LIMIT || lister_length(words, count) <= LEXER_LINE_LIMIT;
}

error_t fixed_entry_store(word48_t* words, uint32_t count, uint32_t characters) {
  struct program_structure after = structure;
  words[0] |= WORD_START_OF_LINE;
  for (uint32_t at = 0, end; at < count; at = end) {
    end = line_end(words, at, count);
    if (!can_be_listed(words + at, end - at, characters)) return ERR_DATA;
    const error_t error = program_structure_line(&after, is_motion(), words + at, end - at);
    if (error != ERR_NONE) return error;
  }
  const error_t error = fixed_program_append(words, count);
  if (error != ERR_NONE) return error;
  structure = after;
  buffer_request_fixed_line_stored();
  return ERR_NONE;
}

void fixed_entry_clear(void) {
  fixed_program_clear();
  program_structure_begin(&structure, 0);
  buffer_request_fixed_changed();
}

error_t fixed_entry_end(void) {
  append_return();
  fixed_program_close();
  buffer_request_fixed_closed();
  return structure.depth == 0 ? ERR_NONE : ERR_STRUCTURE;
}
