/* The I-variable table as constant data, with an index by group and number so that a look-up takes no search. */
#include "firmware/variables/i_table.h"

#include <stdbool.h>

#include "firmware/base/dimensions.h"
#include "firmware/base/float48.h"
#include "firmware/base/mathematics.h"
#include "firmware/hal/gate_ic.h"
#include "firmware/variables/i_names.h"

enum { FORMAT_D = 0, FORMAT_H = 1 };

static const struct i_entry entries[] = {
    {0, 0, 0, I_KIND_S, 24, 0, I_FIELD_NONE, 0.0}, /* reserved numbers */
#define I_ENTRY(name, group, first, count, kind, bits, format, value, field) \
  {I_GROUP_##group, first, count, I_KIND_##kind, bits, FORMAT_##format, I_FIELD_##field, value},
#include "firmware/variables/i_variables.def"
#undef I_ENTRY
};

enum { ENTRY_COUNT = sizeof entries / sizeof entries[0], WIDEST_GROUP = 192, RESERVED = 99 };

static uint8_t row_of[I_GROUP_COUNT][WIDEST_GROUP];

_Static_assert(ENTRY_COUNT <= 256, "rows are indexed by a byte");

void i_table_initialize(void) {
  for (unsigned row = 1; row < ENTRY_COUNT; ++row)
    for (unsigned i = 0; i < entries[row].count; ++i) row_of[entries[row].group][entries[row].first + i] = (uint8_t)row;
}

static struct i_place in_servo_ic(uint32_t number) {
  struct i_place place = {I_GROUP_SERVO, 0, 0, 0};
  const uint32_t m = (number - 7000u) / 100u;
  const uint32_t inside = number % 50u;
  if (number % 100u < 50u)
    place.instance = m;
  else
    place.instance = m >= 2u ? m - 2u + GATE_IC_STARRED : GATE_IC_COUNT; /* there is no IC 0* or 1* */
  if (inside >= 10u) {
    place.group = I_GROUP_CHANNEL;
    place.channel = inside / 10u - 1u;
  }
  place.offset = inside % 10u;
  return place;
}

static struct i_place in_macro_ic(uint32_t number) {
  struct i_place place = {I_GROUP_MACRO, number % 50u, GATE_IC_MACRO + (number - 6800u) / 50u, 0};
  if (place.offset >= 10u && place.offset < 30u) {
    place.group = I_GROUP_SUPPLEMENTARY;
    place.channel = place.offset / 10u - 1u;
    place.offset %= 10u;
  }
  return place;
}

/* Where the groups stand: `block` numbers to each motor, coordinate system or IC. What is in no group is reserved, as a
 * number of GATHER without a row is. */
static const struct span {
  uint16_t end, first;
  uint8_t group, block, instance; /* of the first block */
} spans[] = {
    {100, 0, I_GROUP_GLOBAL, 100, 0},
    {3300, I_MOTOR_BLOCK, I_GROUP_MOTOR, I_MOTOR_BLOCK, 1},
    {4900, I_ESA_FIRST, I_GROUP_ESA, I_ESA_BLOCK, 0},
    {5000, I_BASE_SYSTEM, I_GROUP_SYSTEM, 100, 0},
    {I_CS_FIRST, I_BASE_GATHER, I_GROUP_GATHER, 100, 0},
    {6700, I_CS_FIRST, I_GROUP_CS, I_CS_BLOCK, 0},
    {I_BASE_MACRO, 6700, I_GROUP_GATHER, 0, 0},
    {7000, I_BASE_MACRO, I_GROUP_MACRO, 0, 0},
    {I_BASE_TABLE, 7000, I_GROUP_SERVO, 0, 0},
    {VARIABLE_COUNT, I_BASE_TABLE, I_GROUP_TABLE, WIDEST_GROUP, 0},
};

struct i_place i_table_place(uint32_t number) {
  const struct span* span = spans;
  while (number >= span->end && span != &spans[sizeof spans / sizeof spans[0] - 1u]) ++span;
  if (span->group == I_GROUP_MACRO) return in_macro_ic(number);
  if (span->group == I_GROUP_SERVO) return in_servo_ic(number);
  if (span->block == 0u) return (struct i_place){I_GROUP_GATHER, RESERVED, 0, 0};
  const uint32_t inside = number - span->first;
  return (struct i_place){span->group, inside % span->block, inside / span->block + span->instance, 0};
}

const struct i_entry* i_table_entry(struct i_place place) { return &entries[row_of[place.group][place.offset]]; }

const struct i_entry* i_table_row(uint32_t number) { return i_table_entry(i_table_place(number)); }

uint32_t i_table_lock(i_group_t group) {
  static const uint8_t LOCKS[I_GROUP_COUNT] = {
      [I_GROUP_MOTOR] = 1,         [I_GROUP_ESA] = 1,   [I_GROUP_CS] = 2,      [I_GROUP_MACRO] = 4,
      [I_GROUP_SUPPLEMENTARY] = 4, [I_GROUP_SERVO] = 4, [I_GROUP_CHANNEL] = 4, [I_GROUP_TABLE] = 8};
  return LOCKS[group];
}

static int32_t reduce(const struct i_entry* entry, uint32_t value) {
  const uint32_t mask = (1u << entry->bits) - 1u, bits = value & mask;
  const bool negative = entry->kind == I_KIND_S && (bits >> (entry->bits - 1u)) != 0u;
  return (int32_t)(negative ? bits | ~mask : bits);
}

double i_table_value(const struct i_entry* entry, double value) {
  if (entry->kind == I_KIND_F) return float48_unpack(float48_pack(value));
  return reduce(entry, (uint32_t)math_nearest(value));
}
