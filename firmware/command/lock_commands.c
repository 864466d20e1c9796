#include "firmware/command/lock_commands.h"

#include "firmware/language/statement_argument.h"
#include "firmware/run/process_locks.h"
#include "firmware/variables/pq_variables.h"

static error_t cmd_lock(struct lexer* lx) {
  uint32_t number;
  const error_t error = statement_lock(lx, &number);
  if (error != ERR_NONE) return error;
  p_variable_write(number >> LOCK_VARIABLE_BIT, process_lock(number & (LOCK_COUNT - 1u)) ? 1.0 : 0.0);
  return ERR_NONE;
}

static error_t cmd_unlock(struct lexer* lx) {
  int32_t number;
  if (lexer_integer(lx, &number) != ERR_NONE || number < 0 || number >= LOCK_COUNT) return ERR_DATA;
  process_unlock((uint32_t)number);
  return ERR_NONE;
}

const struct command_entry lock_commands[] = {{"LOCK", cmd_lock}, {"UNLOCK", cmd_unlock}, {0, 0}};
