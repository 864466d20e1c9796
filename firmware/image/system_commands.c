/* Resets and storage (firmware:5.10), and commands of equipment that is not there. */
#include "firmware/command/command_tables.h"
#include "firmware/kernel/kernel.h"
#include "firmware/motion/motion.h"

static void drop_rest_of_line(struct lexer* lx) {
  while (*lx->at != '\0') ++lx->at;
}

/* What the line holds after a reset is not executed: its addresses are gone. */
static error_t reset(struct lexer* lx) {
  drop_rest_of_line(lx);
  kernel_start(KERNEL_START_SAVED);
  return ERR_NONE;
}

static error_t reset_to_defaults(struct lexer* lx) {
  drop_rest_of_line(lx);
  kernel_start(KERNEL_START_DEFAULTS);
  return ERR_NONE;
}

static error_t save(struct lexer* lx) {
  (void)lx;
  if (motion_any_running()) return ERR_PROGRAM_RUNNING;
  kernel_save();
  return ERR_NONE;
}

/* No ring is modelled: every MACRO auxiliary command times out. */
static error_t macro_auxiliary(struct lexer* lx) {
  drop_rest_of_line(lx);
  return ERR_MACRO;
}

const struct command_entry system_commands[] = {
    {"$$$***", reset_to_defaults}, {"$$$", reset},          {"SAVE", save}, {"MSR", macro_auxiliary},
    {"MSW", macro_auxiliary},      {"MS", macro_auxiliary}, {0, 0},
};
