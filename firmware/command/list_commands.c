/* LIST of programs and of the gather buffer. With a start, each line carries its offset and the reply is cut where a
 * client that takes 1,400 characters at a time would lose the rest: it asks again from the last offset. */
#include "firmware/command/list_commands.h"

#include "firmware/buffers/fixed_programs.h"
#include "firmware/buffers/gather.h"
#include "firmware/buffers/open_buffer.h"
#include "firmware/buffers/program_password.h"
#include "firmware/buffers/regions.h"
#include "firmware/buffers/rotary.h"
#include "firmware/buffers/user_memory.h"
#include "firmware/command/reply.h"
#include "firmware/command/session.h"
#include "firmware/command/table_commands.h"
#include "firmware/kernel/watchdog.h"
#include "firmware/language/constant_text.h"
#include "firmware/language/lister.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/run/run_control.h"
#include "firmware/variables/i_variables.h"

enum {
  LINE_WORDS = 300,        /* what is longer can only be damaged */
  REPLY_CHARACTERS = 1080, /* no line is begun behind these: the longest has 255, its offset and its end */
  LONG_WORD_DIGITS = 6
};

struct part {
  bool is_part; /* a start was given */
  uint32_t start, length;
};

static uint32_t characters; /* of the reply */

static void put(char c) {
  reply_char(c);
  characters++;
}

/* {,start{,length}} */
static error_t read_part(struct lexer* lx, struct part* part) {
  int32_t number;
  *part = (struct part){false, 0, USER_MEMORY_WORDS};
  if (!lexer_further(lx)) return ERR_NONE;
  if (lexer_integer(lx, &number) != ERR_NONE || number < 0) return ERR_DATA;
  part->is_part = true;
  part->start = (uint32_t)number;
  if (!lexer_further(lx)) return ERR_NONE;
  if (lexer_integer(lx, &number) != ERR_NONE || number < 0) return ERR_DATA;
  part->length = (uint32_t)number;
  return ERR_NONE;
}

static void list_line(const word48_t* words, uint32_t count, uint32_t offset, bool with_offset) {
  if (with_offset) {
    integer_text(offset, put);
    put(':');
  }
  lister_line(words, count, (i_integer(I9_LISTING_FORM) & 1) != 0, put);
  reply_end_line();
  characters++;
  watchdog_reload();
}

static error_t list_lines(const struct fixed_program* program, const struct part* part, uint32_t lines) {
  word48_t words[LINE_WORDS];
  if (program == 0 || part->start >= program->words) return ERR_DATA;
  characters = 0;
  for (uint32_t at = 0; at < program->words && at < part->start + (uint64_t)part->length && lines != 0;) {
    const uint32_t count = fixed_program_line(program, at);
    if (at >= part->start) {
      lines--;
      if (part->is_part && characters > REPLY_CHARACTERS) break;
      for (uint32_t i = 0; i < count && i < LINE_WORDS; i++) words[i] = fixed_program_word(program, at + i);
      list_line(words, count < LINE_WORDS ? count : LINE_WORDS, at, part->is_part);
    }
    at += count;
  }
  return ERR_NONE;
}

static error_t list_program(const struct fixed_program* program, const struct part* part) {
  return list_lines(program, part, USER_MEMORY_WORDS);
}

static error_t list_fixed(struct lexer* lx, enum fixed_kind kind, bool numbered) {
  int32_t number = (int32_t)session.cs;
  struct part part;
  if (numbered && (lexer_integer(lx, &number) != ERR_NONE || number < 0)) return ERR_DATA;
  const error_t error = read_part(lx, &part);
  if (error != ERR_NONE) return error;
  if (program_password_protects(kind, (uint32_t)number)) return ERR_PASSWORD;
  return list_program(fixed_program_find(kind, (uint32_t)number), &part);
}

/* Lines whose calculation has not begun, as they are at the command; offsets are those of the ring, as PC reports them.
 */
static error_t list_ring(uint32_t cs, uint32_t lines, bool with_offset) {
  word48_t words[LINE_WORDS];
  if (rotary_buffers[cs].size == 0) return ERR_DATA;
  rotary_hold(true);
  const struct rotary_lines ahead = rotary_lines_ahead(cs);
  for (uint32_t line = 0, at = 0; line < lines && at < ahead.words; line++) {
    const uint32_t first = at;
    do {
      words[at - first] = rotary_word(cs, rotary_offset(cs, ahead.offset, at));
      if (at != first && (words[at - first] & WORD_START_OF_LINE) != 0) break;
      at++;
    } while (at - first < LINE_WORDS && at < ahead.words);
    list_line(words, at - first, rotary_offset(cs, ahead.offset, first), with_offset);
  }
  rotary_hold(false);
  if (ahead.words == 0) reply_no_line();
  return ERR_NONE;
}

static error_t list_gather(struct lexer* lx) {
  struct part part;
  const uint32_t size = gather_stored_words(), base = region_base(REGION_GATHER, 0);
  const error_t error = read_part(lx, &part);
  if (error != ERR_NONE) return error;
  if (part.start >= size) return ERR_DATA;
  for (uint32_t at = part.start; at < size && at < part.start + (uint64_t)part.length; at++) {
    const word48_t word = user_memory_read(base + at);
    reply_hex((uint32_t)(word >> 24) & HAL_WORD_MASK, LONG_WORD_DIGITS);
    reply_hex((uint32_t)word & HAL_WORD_MASK, LONG_WORD_DIGITS);
    reply_end_line();
    watchdog_reload();
  }
  return ERR_NONE;
}

/* LIST PC{,count}, LIST PE{,count}: lines from the one that is calculated next, or executes. What has been calculated
 * of a ring is free again. */
static error_t list_pointer(struct lexer* lx, bool executing) {
  const struct coordinate_system* s = &coordinate_systems[session.cs];
  struct program_trace trace;
  int32_t count = 1;
  if (lexer_further(lx) && (lexer_integer(lx, &count) != ERR_NONE || count < 1)) return ERR_DATA;
  if (executing)
    run_executing(session.cs, &trace);
  else
    run_calculating(session.cs, &trace);
  const struct program_place* place = &trace.places[trace.depth];
  if (place->program == 0) return executing && s->active ? ERR_DATA : list_ring(session.cs, (uint32_t)count, true);
  if (program_password_protects(FIXED_PROG, place->program)) return ERR_PASSWORD;
  const struct part part = {true, place->offset, USER_MEMORY_WORDS};
  return list_lines(fixed_program_find(FIXED_PROG, place->program), &part, (uint32_t)count);
}

static error_t list_open(void) {
  const struct part whole = {false, 0, USER_MEMORY_WORDS};
  if (open_buffer_kind() == OPEN_FIXED) return list_program(fixed_program_opened(), &whole);
  return open_buffer_kind() == OPEN_ROTARY ? list_ring(session.cs, USER_MEMORY_WORDS, false) : ERR_DATA;
}

static error_t cmd_list(struct lexer* lx) {
  error_t error;
  if (lexer_keyword(lx, "PROGRAM") || lexer_keyword(lx, "PROG")) return list_fixed(lx, FIXED_PROG, true);
  if (lexer_keyword(lx, "PLC")) return list_fixed(lx, FIXED_PLC, true);
  if (lexer_keyword(lx, "PC")) return list_pointer(lx, false);
  if (lexer_keyword(lx, "PE")) return list_pointer(lx, true);
  if (lexer_keyword(lx, "FORWARD") || lexer_keyword(lx, "FWD")) return list_fixed(lx, FIXED_FORWARD, false);
  if (lexer_keyword(lx, "INVERSE") || lexer_keyword(lx, "INV")) return list_fixed(lx, FIXED_INVERSE, false);
  if (lexer_keyword(lx, "ROTARY") || lexer_keyword(lx, "ROT")) return list_ring(session.cs, USER_MEMORY_WORDS, false);
  if (lexer_keyword(lx, "GATHER") || lexer_keyword(lx, "GAT")) return list_gather(lx);
  if (table_list(lx, &error)) return error;
  const char c = lexer_peek(lx);
  return c == '\0' ? list_open() : ERR_DATA;
}

const struct command_entry list_commands[] = {{"LIST", cmd_list}, {"LIS", cmd_list}, {0, 0}};
