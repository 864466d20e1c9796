/* Resets, storage and the password of programs (firmware:5.10), and commands of equipment that is not there. */
#include "firmware/image/system_commands.h"

#include "firmware/buffers/program_password.h"
#include "firmware/command/session.h"
#include "firmware/host/dpram_ascii.h"
#include "firmware/host/line_input.h"
#include "firmware/image/start.h"
#include "firmware/run/run_control.h"

static void drop_rest_of_line(struct lexer* lx) {
  while (*lx->at != '\0') ++lx->at;
}

/* What the line holds after a reset is not executed: its addresses are gone. */
static error_t reset(struct lexer* lx) {
  drop_rest_of_line(lx);
  start(START_SAVED);
  return ERR_NONE;
}

static error_t reset_to_defaults(struct lexer* lx) {
  drop_rest_of_line(lx);
  start(START_DEFAULTS);
  return ERR_NONE;
}

static error_t save(struct lexer* lx) {
  (void)lx;
  if (run_any_running()) return ERR_PROGRAM_RUNNING;
  start_save();
  return ERR_NONE;
}

/* Everything behind `=` counts, as it was typed: capitals, blanks, quotes, semicolons. Not from a program: its listing
 * would tell the password. */
static error_t password(struct lexer* lx) {
  if (session_is_program()) {
    drop_rest_of_line(lx);
    return ERR_DATA;
  }
  if (!lexer_accept(lx, '=')) return ERR_DATA;
  const char* text = dpram_ascii_as_typed(line_input_as_typed(lx->at));
  drop_rest_of_line(lx);
  uint32_t length = 0;
  while (text[length] != '\0') ++length;
  return program_password_enter(text, length);
}

/* No ring is modelled: every MACRO auxiliary command times out. */
static error_t macro_auxiliary(struct lexer* lx) {
  drop_rest_of_line(lx);
  return ERR_MACRO;
}

const struct command_entry system_commands[] = {
    {"$$$***", reset_to_defaults}, {"$$$", reset},          {"SAVE", save},         {"MSR", macro_auxiliary},
    {"MSW", macro_auxiliary},      {"MS", macro_auxiliary}, {"PASSWORD", password}, {0, 0},
};
