#include "firmware/run/synchronous.h"

#include "firmware/base/mathematics.h"
#include "firmware/kernel/slice.h"
#include "firmware/motion/lookahead_buffer.h"
#include "firmware/motion/path.h"
#include "firmware/motion/plan_move.h"
#include "firmware/variables/i_variables.h"
#include "firmware/variables/m_variables.h"

#define LONGEST_TIMER 8388607.0

enum { MOVE_TIME = 0xFF }; /* an action: Isx11, not an M-variable */

struct assignment {
  uint32_t move; /* counted as coordinate_system.started */
  uint16_t number;
  uint8_t action; /* enum synchronous, MOVE_TIME */
  double value;
};

_Static_assert(sizeof(struct assignment) <= 16, "a slot is two words");

/* A ring: `own`, or in lookahead the slots of its buffer (motion:7.3/4), as it was when the first one came. */
static struct {
  struct assignment own[SYNCHRONOUS_QUEUE];
  struct assignment* ring;
  uint32_t size, first, count;
} queues[COORDINATE_SYSTEMS];

static uint32_t filled; /* a bit a queue that is not empty */

void synchronous_initialize(void) {
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; cs++) queues[cs].first = queues[cs].count = 0;
  filled = 0;
}

static struct assignment* waiting(uint32_t cs, uint32_t ahead) {
  return &queues[cs].ring[(queues[cs].first + ahead) % queues[cs].size];
}

bool synchronous_is_short(const struct instruction* in) {
  return in->operation == OP_STATEMENT && in->number >= WORD_KEY(4, 1, 0) && in->number < WORD_KEY(4, 5, 0);
}

static void show(uint32_t cs) {
  coordinate_systems[cs].slots_wait = queues[cs].count != 0 && queues[cs].ring != queues[cs].own;
}

static bool looks(uint32_t cs) {
  return coordinate_systems[cs].motors != 0 && i_integer(i_cs(cs, ISX13_SEGMENTATION_TIME)) != 0 &&
         i_integer(i_cs(cs, ISX20_LOOKAHEAD_LENGTH)) != 0 && lookahead_buffer_is_defined(cs);
}

enum room { ROOM, ROOM_LATER, ROOM_NONE };

/* In lookahead calculation does not wait: that would be for ever, where what has to come is behind it. */
static enum room room_for_one(uint32_t cs) {
  const bool ahead = looks(cs);
  if (queues[cs].count == 0) {
    void* slots = queues[cs].own;
    queues[cs].size = ahead ? lookahead_slots(cs, &slots) : SYNCHRONOUS_QUEUE;
    queues[cs].ring = slots;
    queues[cs].first = 0;
  }
  if (queues[cs].count < queues[cs].size) return ROOM;
  return ahead && queues[cs].ring != queues[cs].own ? ROOM_NONE : ROOM_LATER;
}

enum executed synchronous_add(uint32_t cs, const struct instruction* in) {
  struct motion_program* p = &motion_programs[cs];
  const struct evaluator* ev = &p->x.evaluator;
  uint32_t number = in->number, action = in->group;
  const enum room room = room_for_one(cs);
  if (room == ROOM_LATER)
    return waiting(cs, 0)->move == coordinate_systems[cs].planned + 1u ? executor_fail(&p->x, RUN_TIME_SYNCHRONOUS)
                                                                       : EXECUTED_LATER;
  if (in->operation == OP_SYNCHRONOUS_INDEXED) {
    if (ev->depth < 2) return EXECUTED_ERROR;
    number = variable_index(ev->stack[ev->depth - 2u]);
  } else if (in->operation == OP_STATEMENT) {
    number = (in->number & 0x3FFu) + p->x.prefix;
    action = (in->number >> 10 & 7u) - 1u;
  }
  if (room == ROOM_NONE) {
    coordinate_systems[cs].slots_short = true;
    return executor_pass(&p->x);
  }
  struct assignment* a = waiting(cs, queues[cs].count++);
  a->move = coordinate_systems[cs].planned + 1u;
  a->number = (uint16_t)(number % VARIABLE_COUNT);
  a->action = (uint8_t)action;
  a->value = in->value;
  filled |= 1u << cs;
  show(cs);
  return executor_pass(&p->x);
}

/* The move that was planned last, if segments make it; null: it is the calculated one, which comes behind all of them.
 */
static const struct path_move* of_segments(uint32_t cs) {
  return paths[cs].count == 0 ? 0 : path_of(&paths[cs], paths[cs].count - 1u);
}

bool synchronous_is_move(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  return of_segments(cs) != 0 || s->moves[s->executing ^ 1u].kind != MOVE_DWELL;
}

/* ms of the program that the move takes from rest to rest; 0: nobody knows. */
static double time_of(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  const struct move* m = &s->moves[s->executing ^ 1u];
  const struct path_move* last = of_segments(cs);
  if (last != 0) { return math_scale((double)(last->time + last->acceleration), -PATH_TIME_BITS); }
  return m->kind == MOVE_OWN ? 0.0 : plan_milliseconds(m->time + m->acceleration);
}

/* A timer has 24 bits. */
static double timer_of(double cycles) {
  if (!(cycles > 0.0)) return 0.0;
  return cycles < LONGEST_TIMER ? math_floor(cycles + 0.5) : LONGEST_TIMER;
}

/* No room: it is left out, the timer tells nothing (motion:8.3/3). */
void synchronous_move_time(uint32_t cs) {
  const double ahead = cs_real(cs, ISX14_END_OF_MOVE_ANTICIPATION), time = time_of(cs);
  slice_pause();
  if (ahead == 0.0 || time == 0.0) return;
  if (room_for_one(cs) != ROOM) {
    coordinate_systems[cs].slots_short = true;
    return;
  }
  const double units = math_scale(time + ahead, TRAJECTORY_FRACTION_BITS);
  struct assignment* a = waiting(cs, queues[cs].count++);
  a->move = coordinate_systems[cs].planned;
  a->number = (uint16_t)cs;
  a->action = MOVE_TIME;
  a->value = timer_of(units / (double)coordinate_systems[cs].increment_full);
  filled |= 1u << cs;
  show(cs);
}

static void assign(const struct assignment* a) {
  if (a->action == MOVE_TIME) {
    i_timer_write(i_cs(a->number, ISX11_TIMERS), (int32_t)math_to_integer(a->value));
    return;
  }
  if (a->action == SYNCHRONOUS_SET) {
    m_variable_write(a->number, a->value);
    return;
  }
  const enum math_bits operation = a->action == SYNCHRONOUS_AND  ? MATH_AND
                                   : a->action == SYNCHRONOUS_OR ? MATH_OR
                                                                 : MATH_XOR;
  m_variable_write(a->number, math_bitwise(operation, m_variable_read(a->number), a->value));
}

/* Its move has started, or nothing is left that could start: the last ones are made too. */
static bool is_due(uint32_t cs) {
  const struct coordinate_system* s = &coordinate_systems[cs];
  if (queues[cs].count == 0) return false;
  return (int32_t)(s->started - waiting(cs, 0)->move) >= 0 ||
         (!s->running && !s->active && !s->next_valid && paths[cs].count == 0);
}

static void remove_first(uint32_t cs) {
  queues[cs].first = (queues[cs].first + 1u) % queues[cs].size;
  if (--queues[cs].count == 0) filled &= ~(1u << cs);
  show(cs);
}

bool synchronous_waits(void) { return filled != 0; }

void synchronous_assign(void) {
  for (uint32_t cs = 0, left = filled; left != 0; cs++, left >>= 1)
    while ((left & 1u) != 0 && is_due(cs)) {
      const struct assignment made = *waiting(cs, 0);
      remove_first(cs);
      assign(&made);
      slice_pause(); /* an abort that comes here empties the queue */
    }
}

void synchronous_forget(uint32_t cs) {
  queues[cs].first = queues[cs].count = 0;
  filled &= ~(1u << cs);
  show(cs);
}
