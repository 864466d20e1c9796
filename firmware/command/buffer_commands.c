/* What is open for entry. A fixed motion or kinematic program is opened only while nothing runs, and leaves no
 * coordinate system pointing to a program; a PLC may be opened at any time and stands still from then on. */
#include "firmware/command/buffer_commands.h"

#include "firmware/base/dimensions.h"
#include "firmware/buffers/fixed_entry.h"
#include "firmware/buffers/open_buffer.h"
#include "firmware/buffers/program_password.h"
#include "firmware/buffers/regions.h"
#include "firmware/buffers/rotary.h"
#include "firmware/command/program_line.h"
#include "firmware/command/reply.h"
#include "firmware/command/session.h"
#include "firmware/motion/coordinate_system.h"
#include "firmware/run/plc_control.h"
#include "firmware/run/run_control.h"

/* What stands in the way, in this order: a buffer is open, a program runs, the password is missing. */
static error_t may_open(enum fixed_kind kind, uint32_t number) {
  if (open_buffer_kind() != OPEN_NONE) return ERR_BUFFER_OPEN;
  if (kind != FIXED_PLC && run_any_running()) return ERR_PROGRAM_RUNNING;
  return program_password_protects(kind, number) ? ERR_PASSWORD : ERR_NONE;
}

static error_t open_fixed(enum fixed_kind kind, uint32_t number) {
  const error_t error = may_open(kind, number);
  return error != ERR_NONE ? error : open_buffer_open_fixed(kind, number);
}

static error_t open_numbered(struct lexer* lx, enum fixed_kind kind, int32_t first, int32_t last) {
  int32_t number;
  if (lexer_integer(lx, &number) != ERR_NONE || number < first || number > last) return ERR_DATA;
  const error_t error = open_fixed(kind, (uint32_t)number);
  if (error != ERR_NONE) return error;
  if (kind == FIXED_PLC)
    plc_disable(1u << number);
  else
    coordinate_systems_forget_programs();
  return ERR_NONE;
}

static error_t open_kinematic(enum fixed_kind kind) {
  const error_t error = open_fixed(kind, session.cs);
  if (error == ERR_NONE) coordinate_systems_forget_programs();
  return error;
}

static error_t open_named(struct lexer* lx) {
  enum open_buffer kind = OPEN_ROTARY;
  if (lexer_keyword(lx, "PROGRAM") || lexer_keyword(lx, "PROG"))
    return open_numbered(lx, FIXED_PROG, 1, FIXED_PROG_LIMIT);
  if (lexer_keyword(lx, "PLC")) return open_numbered(lx, FIXED_PLC, 0, FIXED_PLC_COUNT - 1); /* PLCC takes no text */
  if (lexer_keyword(lx, "FORWARD") || lexer_keyword(lx, "FWD")) return open_kinematic(FIXED_FORWARD);
  if (lexer_keyword(lx, "INVERSE") || lexer_keyword(lx, "INV")) return open_kinematic(FIXED_INVERSE);
  if (lexer_keyword(lx, "BINARY") || lexer_keyword(lx, "BIN")) kind = OPEN_BINARY_ROTARY;
  if (!lexer_keyword(lx, "ROTARY") && !lexer_keyword(lx, "ROT")) return ERR_DATA;
  return open_buffer_open(kind);
}

static error_t cmd_open(struct lexer* lx) {
  const error_t error = open_named(lx);
  if (error == ERR_NONE) session_own_buffer();
  return error;
}

/* A line entered so far is stored first: CLOSE at its end belongs to it. */
static error_t cmd_close(struct lexer* lx) {
  if (!lexer_keyword(lx, "ALL") && !session_may_close_buffer()) return ERR_NONE; /* another port has opened it */
  const error_t stored = program_line_commit();
  const error_t closed = open_buffer_close();
  return stored != ERR_NONE ? stored : closed;
}

static error_t clear_rotary(uint32_t cs) {
  if (rotary_buffers[cs].size == 0) return ERR_NO_ROOM;
  if (run_is_running(cs)) return ERR_PROGRAM_RUNNING;
  program_line_abandon();
  rotary_clear(cs);
  return ERR_NONE;
}

static bool is_binary_open(void) { return open_buffer_kind() == OPEN_BINARY_ROTARY && session_owns_buffer(); }

/* Motion programs may run while PLCs go: their words move, as for OPEN PLC. */
static error_t clear_all(uint32_t kinds) {
  const bool plcs_alone = kinds == 1u << FIXED_PLC;
  if (open_buffer_kind() != OPEN_NONE) return ERR_BUFFER_OPEN;
  if (!plcs_alone && run_any_running()) return ERR_PROGRAM_RUNNING;
  for (uint32_t i = 0; i < fixed_programs_count(); i++) {
    const struct fixed_program* program = fixed_program_at(i);
    const bool goes = (kinds >> program->kind & 1u) != 0;
    if (goes && program_password_protects((enum fixed_kind)program->kind, program->number)) return ERR_PASSWORD;
  }
  plc_disable(PLC_ALL);
  fixed_programs_erase(kinds);
  if (!plcs_alone) coordinate_systems_forget_programs();
  return ERR_NONE;
}

static error_t cmd_clear(struct lexer* lx) {
  if (lexer_keyword(lx, "ALL"))
    return clear_all(lexer_keyword(lx, "PLCS") ? 1u << FIXED_PLC : (1u << FIXED_KINDS) - 1u);
  if (!program_buffer_open() && !is_binary_open()) return ERR_BUFFER_OPEN; /* so numbered whatever is open */
  if (open_buffer_kind() != OPEN_FIXED) return clear_rotary(session.cs);
  program_line_abandon();
  fixed_entry_clear();
  return ERR_NONE;
}

static error_t cmd_size(struct lexer* lx) {
  (void)lx;
  int64_t words = region_open_words();
  reply_integer(open_buffer_kind() == OPEN_NONE ? words : -words - 1); /* one's complement while a buffer is open */
  reply_end_line();
  return ERR_NONE;
}

const struct command_entry buffer_commands[] = {{"CLOSE", cmd_close},
                                                {"CLEAR", cmd_clear},
                                                {"OPEN", cmd_open},
                                                {"SIZE", cmd_size},
                                                {"CLS", cmd_close},
                                                {"CLR", cmd_clear},
                                                {0, 0}};
