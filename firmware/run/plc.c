/* A turn is left between statements only. What a turn leaves is gone on with at the next: a loop, a statement whose
 * text has no room, a pause. A PLC that cannot go on is disabled. */
#include "firmware/run/plc.h"

#include "firmware/base/dimensions.h"
#include "firmware/buffers/fixed_programs.h"
#include "firmware/buffers/program_links.h"
#include "firmware/language/statement_argument.h"
#include "firmware/language/statement_key.h"
#include "firmware/run/plc_control.h"
#include "firmware/run/shared_statements.h"
#include "firmware/variables/i_variables.h"
#include "firmware/variables/pq_variables.h"

enum { I5_REAL_TIME = 1, I5_BACKGROUND = 2 };

/* PLC 0: real-time task; the others: background. Initialised while neither runs. */
static struct plc {
  struct executor x;
  struct program_caller caller; /* ADDRESS */
} plcs[FIXED_PLC_COUNT];

static uint32_t turn; /* of the last scan. Background */

static void to_the_top(uint32_t number) {
  struct plc* plc = &plcs[number];
  reader_fixed(&plc->x.at.reader, FIXED_PLC, number, 0);
  executor_begin(&plc->x, plc->caller.cs);
}

static void begin(uint32_t number) {
  plcs[number].caller =
      (struct program_caller){.task = number == 0 ? PROGRAM_REAL_TIME : PROGRAM_BACKGROUND, .cs = 0, .motor = 0};
  to_the_top(number);
}

void plc_initialize(void) {
  turn = 0;
  plc_control_initialize();
}

/* The one that a part of ADDRESS names, from 0; `present` where it names none that there is. */
static uint32_t addressed(uint32_t part, uint32_t count, uint32_t present) {
  double number = part;
  if ((part & ADDRESS_VARIABLE) != 0) number = p_variable_read(part & (ADDRESS_VARIABLE - 1u));
  return number >= 1.0 && number < (double)count + 1.0 ? (uint32_t)number - 1u : present;
}

static void address(struct plc* plc, uint32_t number) {
  plc->caller.motor = addressed(statement_address_motor(number), MOTORS, plc->caller.motor);
  plc->caller.cs = plc->x.cs = addressed(statement_address_cs(number), COORDINATE_SYSTEMS, plc->caller.cs);
}

static enum program_output statement(struct plc* plc, const struct instruction* in) {
  if (in->operation != OP_LIST || in->group != KEY_ADDRESS) return shared_statement(&plc->x, in, &plc->caller);
  address(plc, in->number);
  return OUTPUT_DONE;
}

/* One step. False: the turn is over. */
static bool step(uint32_t number) {
  struct plc* plc = &plcs[number];
  struct instruction in;
  switch (executor_step(&plc->x, &in)) {
    case EXECUTED_WORD:
    case EXECUTED_LINE:
      return true;
    case EXECUTED_STATEMENT:
      switch (statement(plc, &in)) {
        case OUTPUT_DONE:
          (void)executor_pass(&plc->x);
          return true;
        case OUTPUT_LATER:
          return false;
        default:
          plc_disable(1u << number);
          return false;
      }
    case EXECUTED_END:
      to_the_top(number);
      return false;
    default: /* never for later: while programs move, none is at its turn */
      plc_disable(1u << number);
      return false;
  }
}

static bool is_paused_here(uint32_t number) {
  const struct executor* x = &plcs[number].x;
  return !x->at.begun && plc_is_paused(number);
}

/* The program being entered is not executed, even if it is enabled again before CLOSE. */
static bool is_open(uint32_t number) {
  const struct fixed_program* program = fixed_program_opened();
  return program != 0 && program->kind == FIXED_PLC && program->number == number;
}

static void scan(uint32_t number, bool gives_way) {
  const struct executor* x = &plcs[number].x;
  if (is_open(number)) return;
  if (plc_begins(number)) begin(number);
  const uint32_t jumps_back = x->jumps_back;
  while (step(number) && !is_paused_here(number) && !(gives_way && x->jumps_back != jumps_back)) {}
}

static bool plc0_is_on(void) { return (i_integer(I5_PLC_CONTROL) & I5_REAL_TIME) != 0 && (plc_enabled() & 1u) != 0; }

/* Its links are made in the background: they would take too long in an interrupt. */
static const struct fixed_program* plc0_without_links(void) {
  const struct fixed_program* program = fixed_program_find(FIXED_PLC, 0);
  return program == 0 || program->linked || is_open(0) ? 0 : program;
}

void plc_real_time(void) {
  if (plc0_is_on() && (fixed_programs_generation() & 1u) == 0 && plc0_without_links() == 0) scan(0, false);
}

static uint32_t waiting(void) { return (i_integer(I5_PLC_CONTROL) & I5_BACKGROUND) != 0 ? plc_enabled() & ~1u : 0; }

bool plc_background_any(void) { return waiting() != 0 || (plc0_is_on() && plc0_without_links() != 0); }

static void link_plc0(void) {
  const struct fixed_program* program = plc0_is_on() ? plc0_without_links() : 0;
  if (program != 0 && program_links_make(program) == LINKS_BAD) plc_disable(1u);
}

void plc_background(void) {
  const uint32_t plcs_waiting = waiting();
  link_plc0();
  if (plcs_waiting == 0) return;
  do turn = (turn + 1u) % FIXED_PLC_COUNT;
  while ((plcs_waiting >> turn & 1u) == 0);
  scan(turn, true);
}
