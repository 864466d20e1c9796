#include "firmware/command/gather_commands.h"

#include "firmware/buffers/gather.h"

static error_t cmd_gather(struct lexer* lx) {
  const bool by_trigger = lexer_keyword(lx, "TRIGGER") || lexer_keyword(lx, "TRIG");
  return by_trigger ? ERR_DATA : gather_begin(); /* its trigger is machine input 2, which no board brings to the CPU */
}

static error_t cmd_end_gather(struct lexer* lx) {
  (void)lx;
  gather_end();
  return ERR_NONE;
}

const struct command_entry gather_commands[] = {
    {"ENDGATHER", cmd_end_gather}, {"END GATHER", cmd_end_gather}, /* as command files spell it */
    {"ENDG", cmd_end_gather},      {"GATHER", cmd_gather},         {"GAT", cmd_gather}, {0, 0}};
