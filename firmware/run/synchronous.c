#include "firmware/run/synchronous.h"

#include "firmware/base/mathematics.h"
#include "firmware/variables/m_variables.h"

static struct {
  struct {
    uint32_t move; /* counted as coordinate_system.started */
    uint16_t number;
    uint8_t action; /* enum synchronous */
    double value;
  } waiting[SYNCHRONOUS_QUEUE];
  uint32_t count;
} queues[COORDINATE_SYSTEMS];

static uint32_t filled; /* a bit a queue that is not empty */

void synchronous_initialize(void) {
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++) queues[cs].count = 0;
  filled = 0;
}

bool synchronous_is_short(const struct instruction* in) {
  return in->operation == OP_STATEMENT && in->number >= WORD_KEY(4, 1, 0) && in->number < WORD_KEY(4, 5, 0);
}

bool synchronous_waiting(uint32_t cs) { return queues[cs].count != 0; }

enum executed synchronous_add(uint32_t cs, const struct instruction* in) {
  struct motion_program* p = &motion_programs[cs];
  const struct evaluator* ev = &p->x.evaluator;
  uint32_t number = in->number, action = in->group;
  if (queues[cs].count == SYNCHRONOUS_QUEUE)
    return queues[cs].waiting[0].move == coordinate_systems[cs].planned + 1u
               ? executor_fail(&p->x, RUN_TIME_SYNCHRONOUS)
               : EXECUTED_LATER;
  if (in->operation == OP_SYNCHRONOUS_INDEXED) {
    if (ev->depth < 2) return EXECUTED_ERROR;
    number = variable_index(ev->stack[ev->depth - 2u]);
  } else if (in->operation == OP_STATEMENT) {
    number = (in->number & 0x3FFu) + p->x.prefix;
    action = (in->number >> 10 & 7u) - 1u;
  }
  const uint32_t i = queues[cs].count++;
  queues[cs].waiting[i].move = coordinate_systems[cs].planned + 1u;
  queues[cs].waiting[i].number = (uint16_t)(number % VARIABLE_COUNT);
  queues[cs].waiting[i].action = (uint8_t)action;
  queues[cs].waiting[i].value = in->value;
  filled |= 1u << cs;
  return executor_pass(&p->x);
}

static void assign(uint32_t number, uint32_t action, double value) {
  const int64_t operand = math_to_integer(value);
  if (action == SYNCHRONOUS_SET) {
    m_variable_write(number, value);
    return;
  }
  const int64_t old = math_to_integer(m_variable_read(number));
  const int64_t both = action == SYNCHRONOUS_AND  ? old & operand
                       : action == SYNCHRONOUS_OR ? old | operand
                                                  : old ^ operand;
  m_variable_write(number, (double)both);
}

/* Nothing is left that could start: the last ones are made too. */
static bool is_over(const struct coordinate_system* s) { return !s->running && !s->active && !s->next_valid; }

static void assign_started(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  uint32_t made = 0;
  while (made < queues[cs].count && (is_over(s) || (int32_t)(s->started - queues[cs].waiting[made].move) >= 0)) {
    assign(queues[cs].waiting[made].number, queues[cs].waiting[made].action, queues[cs].waiting[made].value);
    made++;
  }
  for (uint32_t i = made; made != 0 && i < queues[cs].count; i++) queues[cs].waiting[i - made] = queues[cs].waiting[i];
  queues[cs].count -= made;
  if (queues[cs].count == 0) filled &= ~(1u << cs);
}

void synchronous_assign(void) {
  for (uint32_t cs = 0, left = filled; left != 0; cs++, left >>= 1)
    if ((left & 1u) != 0) assign_started(cs);
}

void synchronous_forget(uint32_t cs) {
  queues[cs].count = 0;
  filled &= ~(1u << cs);
}
