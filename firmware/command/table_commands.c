/* Compensation tables on line (firmware:4.3/12). They belong to the addressed motor. Who changes one may have neither
 * an open buffer nor a program that runs. */
#include "firmware/command/table_commands.h"

#include "firmware/buffers/compensation_tables.h"
#include "firmware/buffers/open_buffer.h"
#include "firmware/command/reply.h"
#include "firmware/command/session.h"
#include "firmware/kernel/watchdog.h"
#include "firmware/motion/compensation.h"
#include "firmware/run/run_control.h"

static const char* const names[COMPENSATION_KINDS] = {"COMP", "TCOMP", "BLCOMP"};

static bool named(struct lexer* lx, enum region_kind* kind) {
  for (uint32_t i = 0; i < COMPENSATION_KINDS; i++) {
    if (!lexer_keyword(lx, names[i])) continue;
    *kind = (enum region_kind)i;
    return true;
  }
  return false;
}

static bool positive(struct lexer* lx, uint32_t* number) {
  int32_t value;
  if (lexer_integer(lx, &value) != ERR_NONE || value < 1) return false;
  *number = (uint32_t)value;
  return true;
}

static bool motor_number(struct lexer* lx, uint8_t* motor) {
  uint32_t number;
  if (!positive(lx, &number) || number > MOTORS) return false;
  *motor = (uint8_t)(number - 1u);
  return true;
}

/* [#{source}[D],[#{target},]] of COMP alone. */
static bool motors(struct lexer* lx, struct compensation_table* table) {
  if (!lexer_accept(lx, '#')) return true;
  if (!motor_number(lx, &table->source)) return false;
  table->of_desired = lexer_accept(lx, 'D');
  if (!lexer_accept(lx, ',')) return false;
  return !lexer_accept(lx, '#') || (motor_number(lx, &table->target) && lexer_accept(lx, ','));
}

static error_t may_change(void) {
  if (open_buffer_kind() != OPEN_NONE) return ERR_BUFFER_OPEN;
  return run_any_running() ? ERR_PROGRAM_RUNNING : ERR_NONE;
}

static error_t define(struct lexer* lx, enum region_kind kind) {
  const uint8_t motor = (uint8_t)session.motor;
  struct compensation_table table = {.source = motor, .target = motor};
  uint32_t entries;
  if (!positive(lx, &entries) || !lexer_accept(lx, ',')) return ERR_DATA;
  if (kind == REGION_COMP && !motors(lx, &table)) return ERR_DATA;
  if (!positive(lx, &table.span)) return ERR_DATA;
  error_t error = may_change();
  if (error == ERR_NONE) error = compensation_table_define(kind, motor, entries, &table);
  if (error == ERR_NONE) compensation_fill(kind, motor);
  compensation_changed();
  return error;
}

bool table_define(struct lexer* lx, error_t* error) {
  enum region_kind kind;
  if (!named(lx, &kind)) return false;
  *error = define(lx, kind);
  return true;
}

bool table_delete(struct lexer* lx, error_t* error) {
  enum region_kind kind;
  if (!named(lx, &kind)) return false;
  *error = may_change();
  if (*error == ERR_NONE) *error = compensation_table_delete(kind, session.motor);
  compensation_changed();
  return true;
}

static void put_motor(uint8_t motor, bool of_desired) {
  reply_char('#');
  reply_integer(motor + 1);
  if (of_desired) reply_char('D');
  reply_char(',');
}

/* A line that makes the same table of the addressed motor again. */
static void list_definition(enum region_kind kind, const struct compensation_table* table) {
  reply_text("DEFINE ");
  reply_text(names[kind]);
  reply_char(' ');
  reply_integer(region_words(kind, session.motor));
  reply_char(',');
  if (kind == REGION_COMP) {
    put_motor(table->source, table->of_desired);
    put_motor(table->target, false);
  }
  reply_integer(table->span);
  reply_end_line();
}

static error_t list(struct lexer* lx, enum region_kind kind) {
  const struct compensation_table* table = compensation_table(kind, session.motor);
  const bool definition = lexer_keyword(lx, "DEFINE") || lexer_keyword(lx, "DEF");
  if (table == 0) return ERR_DATA;
  if (definition) {
    list_definition(kind, table);
    return ERR_NONE;
  }
  for (uint32_t i = 0; i < region_words(kind, session.motor); i++) {
    reply_integer(compensation_entry(kind, session.motor, i));
    reply_end_line();
    watchdog_reload();
  }
  return ERR_NONE;
}

bool table_list(struct lexer* lx, error_t* error) {
  enum region_kind kind;
  if (!named(lx, &kind)) return false;
  *error = list(lx, kind);
  return true;
}
