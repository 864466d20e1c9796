#include "firmware/command/phase_commands.h"

#include "firmware/base/dimensions.h"
#include "firmware/language/statement_list.h"
#include "firmware/motion/phase_search.h"

static error_t cmd_setphase(struct lexer* lx) { /* 1,3..5 */
  uint32_t of = 0;
  const error_t error = statement_number_list(lx, 1, MOTORS, &of);
  if (error == ERR_NONE) phasing_set_here(of);
  return error;
}

const struct command_entry phase_commands[] = {{"SETPHASE", cmd_setphase}, {0, 0}};
