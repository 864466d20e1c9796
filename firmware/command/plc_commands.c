/* Compiled PLCs cannot be loaded: the commands for them are taken and have no effect. */
#include "firmware/command/plc_commands.h"

#include "firmware/buffers/fixed_programs.h"
#include "firmware/language/statement_list.h"
#include "firmware/run/plc_control.h"

static error_t control(struct lexer* lx, void (*action)(uint32_t plcs)) {
  uint32_t plcs;
  (void)lexer_peek(lx);
  const bool compiled = lexer_keyword(lx, "PLCC");
  if (!compiled && !lexer_keyword(lx, "PLC")) return ERR_DATA;
  const error_t error = statement_number_list(lx, 0, FIXED_PLC_COUNT - 1, &plcs);
  if (error == ERR_NONE && !compiled) action(plcs);
  return error;
}

static error_t cmd_enable(struct lexer* lx) { return control(lx, plc_enable); }
static error_t cmd_disable(struct lexer* lx) { return control(lx, plc_disable); }
static error_t cmd_pause(struct lexer* lx) { return control(lx, plc_pause); }
static error_t cmd_resume(struct lexer* lx) { return control(lx, plc_resume); }

/* DISPLC1 begins as DISPLAY does. */
static error_t cmd_disable_short(struct lexer* lx) {
  lx->at -= sizeof "PLC" - 1;
  return cmd_disable(lx);
}

static error_t cmd_display(struct lexer* lx) { /* not DIS PLAY */
  (void)lx;
  return ERR_NEEDS_BUFFER;
}

const struct command_entry plc_commands[] = {{"DISABLE", cmd_disable},
                                             {"ENABLE", cmd_enable},
                                             {"RESUME", cmd_resume},
                                             {"PAUSE", cmd_pause},
                                             {"DISP", cmd_display},
                                             {"ENA", cmd_enable},
                                             {"DIS", cmd_disable},
                                             {"PAU", cmd_pause},
                                             {"RES", cmd_resume},
                                             {"DISPLC", cmd_disable_short},
                                             {0, 0}};
