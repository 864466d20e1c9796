/* The command interpreter: takes commands from a host line, left to right, until one fails. A command is, in this
 * order: a program statement while a buffer is open, a constant, an address, a variable, the longest keyword of the
 * tables. */
#include "firmware/command/command.h"

#include "firmware/base/dimensions.h"
#include "firmware/buffers/buffer_request.h"
#include "firmware/buffers/compensation_tables.h"
#include "firmware/command/program_line.h"
#include "firmware/command/reply.h"
#include "firmware/command/session.h"
#include "firmware/command/variable_commands.h"
#include "firmware/kernel/slice.h"
#include "firmware/language/statement.h"
#include "firmware/variables/i_hardware.h"
#include "firmware/variables/i_variables.h"
#include "firmware/variables/pq_variables.h"

enum { MOTOR_GROUPS = 4 };

static bool is_digit(char c) { return c >= '0' && c <= '9'; }
static bool is_letter(char c) { return c >= 'A' && c <= 'Z'; }
static bool is_hex_digit(char c) { return is_digit(c) || (c >= 'A' && c <= 'F'); }

/* Addresses -------------------------------------------------------------------------------------------------------- */

/* `&n`, `#n`, `##n`: modal. Without a number the present one is reported. */
static error_t address(struct lexer* lx, uint32_t first, uint32_t count, uint32_t* selected) {
  if (!is_digit(lexer_peek(lx))) {
    reply_integer((int64_t)*selected + first);
    reply_end_line();
    return ERR_NONE;
  }
  int32_t number;
  const error_t error = lexer_integer(lx, &number);
  if (error != ERR_NONE) return error;
  const uint32_t index = (uint32_t)number - first;
  if (index >= count) return ERR_DATA;
  *selected = index;
  return ERR_NONE;
}

static error_t address_cs(struct lexer* lx) {
  const bool selects = is_digit(lexer_peek(lx)) && !session_is_program();
  const error_t error = address(lx, 1, (uint32_t)i_integer(I68_ACTIVE_COORDINATE_SYSTEMS) + 1u, &session.cs);
  if (selects && error == ERR_NONE) buffer_request_host_selects(session.cs);
  if (slice_hurry != 0u) slice_hurry_over(); /* the pin has moved */
  return error;
}

static error_t address_motor(struct lexer* lx) {
  if (*lx->at != '#') return address(lx, 1, MOTORS, &session.motor);
  ++lx->at;
  return address(lx, 0, MOTOR_GROUPS, &session.motor_group);
}

/* Keywords --------------------------------------------------------------------------------------------------------- */

/* P, V and F report: clients write them one behind the other, and variables behind them (`#1?PVF#2?PVFM190`). */
static bool is_report(const char* at) {
  return (*at == 'P' && !is_digit(at[1]) && at[1] != '(') || *at == 'V' || *at == 'F';
}

static bool is_variable(const char* at) {
  return (*at == 'I' || *at == 'M' || *at == 'P' || *at == 'Q') && (is_digit(at[1]) || at[1] == '(');
}

/* Commands of one letter stop, start and abort: they must stand alone. `RAPID`, `A10` or `UUU` are something else. */
static bool stands_alone(const char* at, const char* keyword) {
  static const char lonely[] = "AEFHKPQRSV";
  if (keyword[1] != '\0') return true;
  if (is_report(at)) {
    while (is_report(at + 1)) ++at;
    if (is_variable(at + 1)) return true;
  }
  for (const char* letter = lonely; *letter != '\0'; ++letter) {
    if (*letter != *at) continue;
    const char next = at[1];
    return !is_letter(next) && !is_digit(next) && next != '(' && next != '.';
  }
  return true;
}

static uint32_t text_length(const char* text) {
  uint32_t length = 0;
  while (text[length] != '\0') ++length;
  return length;
}

static void longest(const struct command_entry* table, struct lexer lx, const struct command_entry** best,
                    uint32_t* best_length) {
  for (; table->keyword != 0; ++table) {
    struct lexer probe = lx;
    if (!lexer_keyword(&probe, table->keyword) || !stands_alone(lx.at, table->keyword)) continue;
    const uint32_t length = text_length(table->keyword);
    if (length <= *best_length) continue;
    *best = table;
    *best_length = length;
  }
}

static error_t keyword(struct lexer* lx) {
  const struct command_entry* best = 0;
  uint32_t length = 0;
  for (const struct command_entry* const* table = command_tables; *table != 0; ++table)
    longest(*table, *lx, &best, &length);
  if (best == 0) return statement_starts(*lx) ? ERR_NEEDS_BUFFER : ERR_DATA;
  (void)lexer_keyword(lx, best->keyword);
  return best->run(lx);
}

/* One command ------------------------------------------------------------------------------------------------------ */

static bool starts_constant(const char* at) {
  if (*at == '$') return is_hex_digit(at[1]);
  if (*at == '-' || *at == '+') ++at;
  return is_digit(*at) || (*at == '.' && is_digit(at[1]));
}

/* The next entry of the table that the host fills, else P0. */
static error_t constant(struct lexer* lx) {
  double value;
  const error_t error = lexer_constant(lx, &value);
  if (error != ERR_NONE) return error;
  if (compensation_is_filling() && !session_is_program()) return compensation_take(value);
  p_variable_write(0, value);
  return ERR_NONE;
}

static error_t one_command(struct lexer* lx) {
  error_t error;
  const char first = lexer_peek(lx);
  if (first == '&' || first == '#') { /* no statement begins so: the pin is waiting (host-bus:5.7, T_CS) */
    ++lx->at;
    return first == '&' ? address_cs(lx) : address_motor(lx);
  }
  if (program_statement(lx, &error)) return error;
  if (slice_hurry != 0u) slice_hurry_over(); /* a command may take long, and BREQ does not wait for it */
  if (starts_constant(lx->at)) return constant(lx);
  struct lexer after = *lx;
  ++after.at;
  const char second = lexer_peek(&after);
  if ((first == 'I' || first == 'P' || first == 'Q' || first == 'M') && (is_digit(second) || second == '(')) {
    *lx = after;
    return variable_command(lx, first);
  }
  return keyword(lx);
}

/* A comma behind a query divides it from the next command (`&2#4->,`), behind anything else it is an error. */
error_t command_line(const char* line) {
  struct lexer lx = {program_line_begin(line)};
  error_t error = ERR_NONE;
  while (error == ERR_NONE && lexer_peek(&lx) != '\0') {
    const uint32_t reported = reply_line_count();
    error = one_command(&lx);
    if (reply_line_count() != reported) (void)lexer_accept(&lx, ',');
  }
  if (error == ERR_NONE)
    error = program_line_commit();
  else
    program_line_abandon();
  i_hardware_apply_clock_directions();
  return error;
}
