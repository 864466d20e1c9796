/* The position of the source is taken modulo the table's span without a division: times 2^64/span it is a 64-bit number
 * of turns, whose upper half times the number of entries is the entry, and the fraction between it and the next. A
 * position is the middle of its unit, so that what the factor is rounded by does not put it into the turn before. */
#include "firmware/motion/compensation.h"

#include <stdbool.h>

#include "firmware/base/dimensions.h"
#include "firmware/base/mathematics.h"
#include "firmware/base/memory_map.h"
#include "firmware/base/rework.h"
#include "firmware/base/status.h"
#include "firmware/buffers/compensation_tables.h"
#include "firmware/buffers/regions.h"
#include "firmware/hal/hal.h"
#include "firmware/motion/fixed_point.h"
#include "firmware/motion/motor.h"
#include "firmware/variables/i_variables.h"

enum { PART_OF_COUNT = 16, NONE = 0xFF };

struct table {
  uint64_t half_turns; /* 2^63 / span */
  uint32_t before;     /* address of the word before entry 1 */
  uint32_t count;
  int32_t unit; /* position units of the target in a unit of an entry */
  uint8_t source, next;
  bool of_desired, wraps;
};

static struct set {
  struct table tables[COMPENSATION_KINDS][MOTORS];
  uint8_t first[COMPENSATION_KINDS][MOTORS]; /* of a target's tables, NONE: it has none */
  uint32_t of_position, of_torque;           /* as the masks of the header */
} sets[2];
static const struct set* present; /* the servo task's */
static struct rework rework;
static volatile uint32_t changes;
static int64_t given[MOTORS]; /* S: what a motor's position has of its tables */

uint32_t compensation_of_position, compensation_of_torque; /* the first: COMP */

static uint64_t half_turns_of(uint32_t span, uint32_t source) {
  const double units = (double)span * POSITION_SUBCOUNT * (double)motors[source].position_scale;
  return units < 2.0 ? 0u : (uint64_t)math_to_integer(math_scale(1.0 / units, 62)) << 1;
}

static void take(struct set* set, enum region_kind kind, uint32_t motor) {
  const struct compensation_table* table = compensation_table(kind, motor);
  if (table == 0 || i_integer(I51_COMPENSATION_TABLES) == 0) return;
  const uint32_t span = table->span;
  set->tables[kind][motor] = (struct table){
      .before = MEMORY_BUFFERS + table->base - 1u,
      .half_turns = half_turns_of(span, table->source),
      .count = region_words(kind, motor),
      .unit = kind == REGION_TCOMP ? 1 : motors[table->target].position_scale * (POSITION_SUBCOUNT / PART_OF_COUNT),
      .source = table->source,
      .next = set->first[kind][table->target],
      .of_desired = table->of_desired || kind == REGION_BLCOMP,
      .wraps = i_integer(I30_COMPENSATION_TABLE_WRAP) != 0};
  set->first[kind][table->target] = (uint8_t)motor;
  if (kind == REGION_COMP) set->of_position |= 1u << table->target;
  if (kind == REGION_TCOMP) set->of_torque |= 1u << table->target;
}

/* That of the others is made anew. */
static void leave(uint32_t motor) {
  const uint32_t state = hal_mask_servo();
  compensation_of_position &= ~(1u << motor);
  motors[motor].compensation -= given[motor];
  given[motor] = 0;
  hal_unmask(state);
}

static void change(void) {
  struct set* set = present == &sets[0] ? &sets[1] : &sets[0];
  __builtin_memset(set->first, NONE, sizeof set->first);
  set->of_position = set->of_torque = 0;
  for (uint32_t kind = 0; kind < COMPENSATION_KINDS; ++kind)
    for (uint32_t motor = 0; motor < MOTORS; ++motor) take(set, (enum region_kind)kind, motor);
  for (uint32_t left = compensation_of_position & ~set->of_position; left != 0u; left &= left - 1u)
    leave((uint32_t)__builtin_ctz(left));
  const uint32_t state = hal_mask_servo();
  present = set;
  changes++;
  compensation_of_position = set->of_position;
  compensation_of_torque = set->of_torque;
  hal_unmask(state);
  status_show(STATUS_COMPENSATION, i_integer(I51_COMPENSATION_TABLES) != 0);
}

void compensation_initialize(void) {
  __builtin_memset(given, 0, sizeof given);
  rework = (struct rework){.under_way = false};
  change();
}

void compensation_changed(void) {
  if (!rework_begin(&rework, 1)) return;
  do change();
  while (rework_end(&rework) != 0u);
}

/* Entry number 0 is the position 0 and its value 0, or that of the last entry when the table wraps. */
static int32_t entry(const struct table* t, uint32_t number) {
  if (number == 0u && !t->wraps) return 0;
  return hal_signed(*hal_y(t->before + (number == 0u ? t->count : number)));
}

/* A commanded position is the one before its own corrections. */
static int64_t position_of(const struct table* t) {
  const struct motor* m = &motors[t->source];
  return t->of_desired ? m->trajectory + m->master - m->held_back : m->actual;
}

static int64_t value_at(const struct table* t, int64_t position) {
  const uint64_t turn = (2u * (uint64_t)position + 1u) * t->half_turns, place = (turn >> 32) * t->count;
  const uint32_t number = (uint32_t)(place >> 32), fraction = (uint32_t)place;
  const int64_t from = (int64_t)entry(t, number) * t->unit, to = (int64_t)entry(t, number + 1u) * t->unit;
  return from + fixed_part(to - from, fraction);
}

static int64_t sum(enum region_kind kind, uint32_t motor) {
  int64_t all = 0;
  const struct table* tables = present->tables[kind];
  for (uint32_t i = present->first[kind][motor], left = MOTORS; i != NONE && left != 0u; i = tables[i].next, --left)
    all += value_at(&tables[i], position_of(&tables[i]));
  return all;
}

static int64_t position_there(const struct table* t, uint32_t motor, bool closed, int64_t place, int64_t corrected) {
  if (t->source != motor) return position_of(t);
  if (t->of_desired) return closed ? place : place - corrected;
  return closed ? place + corrected : place;
}

/* Of COMP tables, with `corrected` between what it is commanded and where it is. Tables may change meanwhile: a list is
 * gone along for as many as there can be. */
static int64_t sum_there(uint32_t motor, bool closed, int64_t place, int64_t corrected) {
  int64_t all = 0;
  for (uint32_t i = MOTORS, left = MOTORS + 1u; i != NONE && left != 0u; --left) {
    const uint32_t state = hal_mask_servo();
    const struct table* tables = present->tables[REGION_COMP];
    i = i == MOTORS ? present->first[REGION_COMP][motor] : tables[i].next;
    if (i != NONE) all += value_at(&tables[i], position_there(&tables[i], motor, closed, place, corrected));
    hal_unmask(state);
  }
  return all;
}

/* The second look is for tables by the position that has the correction in it, or has it not any more. */
int64_t compensation_there(uint32_t motor, bool closed, int64_t place) {
  if ((compensation_of_position >> motor & 1u) == 0u) return 0;
  return sum_there(motor, closed, place, sum_there(motor, closed, place, 0));
}

uint32_t compensation_changes(void) { return changes; }

int64_t compensation_exchange(uint32_t motor, int64_t sum) {
  if ((compensation_of_position >> motor & 1u) == 0u) return 0;
  const int64_t before = given[motor];
  given[motor] = sum;
  return sum - before;
}

int64_t compensation_position(uint32_t motor) {
  given[motor] = sum(REGION_COMP, motor);
  return given[motor];
}

int64_t compensation_backlash(uint32_t motor) { return sum(REGION_BLCOMP, motor); }

/* With the sign of the output: it makes it larger or smaller. */
int64_t compensation_torque(uint32_t motor, int64_t output) {
  if (output == 0) return 0;
  const int64_t torque = sum(REGION_TCOMP, motor);
  return output > 0 ? torque : -torque;
}
