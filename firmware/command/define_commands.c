/* DEFINE and DELETE (firmware:4.2, firmware:4.3). A running coordinate system keeps its buffers; the order rules are
 * those of regions.c. */
#include "firmware/command/define_commands.h"

#include "firmware/base/dimensions.h"
#include "firmware/buffers/buffer_request.h"
#include "firmware/buffers/compensation_tables.h"
#include "firmware/buffers/fixed_programs.h"
#include "firmware/buffers/gather.h"
#include "firmware/buffers/open_buffer.h"
#include "firmware/buffers/regions.h"
#include "firmware/buffers/rotary.h"
#include "firmware/command/session.h"
#include "firmware/command/table_commands.h"
#include "firmware/language/statement_list.h"
#include "firmware/motion/axis_definition.h"
#include "firmware/motion/axis_matrix.h"
#include "firmware/motion/compensation.h"
#include "firmware/motion/lookahead_buffer.h"
#include "firmware/run/run_control.h"
#include "firmware/variables/i_table.h"

static error_t size_argument(struct lexer* lx, uint32_t* size) {
  int32_t value;
  error_t error = lexer_integer(lx, &value);
  if (error != ERR_NONE) return error;
  if (value < 0) return ERR_DATA;
  *size = (uint32_t)value;
  return ERR_NONE;
}

/* Of as many there is no room. */
static uint32_t at_most(uint64_t words) { return words > UINT32_MAX ? UINT32_MAX : (uint32_t)words; }

static error_t define_lookahead(struct lexer* lx, uint32_t cs) {
  uint32_t segments, outputs;
  uint32_t segment_words = 2 * axis_definition_motors(cs) + 4;
  if (size_argument(lx, &segments) != ERR_NONE || !lexer_accept(lx, ',') || size_argument(lx, &outputs) != ERR_NONE)
    return ERR_DATA;
  if (segment_words < LOOKAHEAD_WORDS_MINIMUM) segment_words = LOOKAHEAD_WORDS_MINIMUM;
  uint64_t words = (uint64_t)segments * segment_words + (uint64_t)outputs * LOOKAHEAD_WORDS_PER_OUTPUT;
  if (segments == 0) return ERR_DATA;
  if (i_table_of_geo_pmac() && lookahead_buffer_is_anywhere()) return ERR_DATA; /* it has one only */
  const error_t error = region_define(REGION_LOOKAHEAD, cs, at_most(words));
  if (error == ERR_NONE) lookahead_buffer_define(cs, outputs);
  return error;
}

static error_t define_ccbuf(struct lexer* lx, uint32_t cs) {
  uint32_t moves;
  if (size_argument(lx, &moves) != ERR_NONE) return ERR_DATA;
  return region_define(REGION_CCBUF, cs, at_most((uint64_t)moves * CCBUF_WORDS_PER_MOVE));
}

static error_t define_rotary(struct lexer* lx, uint32_t cs) {
  uint32_t words;
  error_t error = size_argument(lx, &words);
  if (error != ERR_NONE) return error;
  if (open_buffer_kind() != OPEN_NONE)
    return ERR_BUFFER_OPEN; /* choice: OPEN ROTARY opens what is defined when it is given */
  return rotary_define(cs, words);
}

static error_t define_gather(struct lexer* lx) {
  uint32_t words;
  char c = lexer_peek(lx);
  if (c < '$' || c > '9') return gather_define(GATHER_ALL_THERE_IS);
  if (size_argument(lx, &words) != ERR_NONE || words == 0u) return ERR_DATA;
  return gather_define(words);
}

static error_t define_tbuf(struct lexer* lx) {
  uint32_t matrices;
  if (size_argument(lx, &matrices) != ERR_NONE) return ERR_DATA;
  const error_t error = region_define(REGION_TBUF, 0, at_most((uint64_t)matrices * TBUF_WORDS_PER_MATRIX));
  if (error == ERR_NONE) axis_matrix_clear();
  return error;
}

static error_t define_user(struct lexer* lx) {
  uint32_t words;
  if (size_argument(lx, &words) != ERR_NONE) return ERR_DATA;
  return open_buffer_kind() != OPEN_NONE ? ERR_BUFFER_OPEN : region_define_user(words);
}

/* A program runs, or assignments of moves that it has left for the next start are in the buffer. */
static bool uses_lookahead(uint32_t cs) { return run_is_running(cs) || coordinate_systems[cs].slots_wait; }

static bool any_uses_lookahead(void) {
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++)
    if (uses_lookahead(cs)) return true;
  return false;
}

static error_t define_any(struct lexer* lx) {
  error_t error;
  uint32_t cs = session.cs;
  bool running = run_is_running(cs);
  if (lexer_keyword(lx, "ROTARY") || lexer_keyword(lx, "ROT"))
    return running ? ERR_PROGRAM_RUNNING : define_rotary(lx, cs);
  if (lexer_keyword(lx, "LOOKAHEAD") || lexer_keyword(lx, "LOOK"))
    return uses_lookahead(cs) ? ERR_PROGRAM_RUNNING : define_lookahead(lx, cs);
  if (lexer_keyword(lx, "CCBUF")) return running ? ERR_PROGRAM_RUNNING : define_ccbuf(lx, cs);
  if (lexer_keyword(lx, "GATHER") || lexer_keyword(lx, "GAT")) return define_gather(lx);
  if (lexer_keyword(lx, "TBUF")) return run_any_running() ? ERR_PROGRAM_RUNNING : define_tbuf(lx);
  if (lexer_keyword(lx, "UBUFFER") || lexer_keyword(lx, "UBUF")) return define_user(lx);
  return table_define(lx, &error) ? error : ERR_DATA;
}

static error_t delete_rotary(uint32_t cs) {
  if (open_buffer_kind() != OPEN_NONE || run_is_running(cs)) return ERR_DATA;
  error_t error = rotary_delete(cs);
  if (error == ERR_NONE) run_forget_rotary(cs);
  return error;
}

/* DELETE ALL TEMPS; DELETE ALL takes the tables away too. */
static error_t delete_all(bool tables) {
  if (open_buffer_kind() != OPEN_NONE) return ERR_DATA;
  if (any_uses_lookahead()) return ERR_PROGRAM_RUNNING;
  gather_delete_always();
  rotary_delete_all();
  if (tables) compensation_tables_delete_all();
  compensation_changed();
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++) run_forget_rotary(cs);
  return ERR_NONE;
}

static error_t delete_any(struct lexer* lx) {
  uint32_t cs = session.cs;
  uint32_t plcs;
  bool running = run_is_running(cs);
  error_t error;
  if (lexer_keyword(lx, "ALL")) return delete_all(!lexer_keyword(lx, "TEMPS") && !lexer_keyword(lx, "TEMP"));
  if (lexer_keyword(lx, "ROTARY") || lexer_keyword(lx, "ROT")) return delete_rotary(cs);
  if (lexer_keyword(lx, "LOOKAHEAD") || lexer_keyword(lx, "LOOK"))
    return uses_lookahead(cs) ? ERR_PROGRAM_RUNNING : region_delete(REGION_LOOKAHEAD, cs);
  if (lexer_keyword(lx, "CCBUF")) return running ? ERR_PROGRAM_RUNNING : region_delete(REGION_CCBUF, cs);
  if (lexer_keyword(lx, "GATHER") || lexer_keyword(lx, "GAT")) return gather_delete();
  if (lexer_keyword(lx, "TBUF")) return run_any_running() ? ERR_PROGRAM_RUNNING : region_delete(REGION_TBUF, cs);
  if (lexer_keyword(lx, "TRACE")) return ERR_NONE; /* there is none of these two: files take them away all the same */
  if (lexer_keyword(lx, "PLCC")) return statement_number_list(lx, 0, FIXED_PLC_COUNT - 1, &plcs);
  return table_delete(lx, &error) ? error : ERR_DATA;
}

/* What is open for the fixed buffer that is being filled has changed: it owns BREQ (firmware:4.6). */
static error_t and_request(error_t error) {
  if (error == ERR_NONE) buffer_request_evaluate();
  return error;
}

error_t define_command(struct lexer* lx) { return and_request(define_any(lx)); }
error_t delete_command(struct lexer* lx) { return and_request(delete_any(lx)); }
