/* The I-variable table as constant data, with an index by group and number so that a look-up takes no search. */
#include "firmware/variables/i_table.h"

#include <stdbool.h>

#include "firmware/base/dimensions.h"
#include "firmware/base/float48.h"
#include "firmware/base/mathematics.h"
#include "firmware/hal/gate_ic.h"
#include "firmware/hal/hal.h"
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

static bool geo_pmac; /* kept: a call in i_table_place would cost each look at a variable 30 cycles */

_Static_assert(ENTRY_COUNT <= 256, "rows are indexed by a byte");

void i_table_initialize(void) {
  geo_pmac = (hal_strap(HAL_STRAP_PRODUCT) & HAL_PRODUCT_GEO_PMAC) != 0u;
  for (unsigned row = 1; row < ENTRY_COUNT; ++row)
    for (unsigned i = 0; i < entries[row].count; ++i) row_of[entries[row].group][entries[row].first + i] = (uint8_t)row;
}

/* The start and each assignment ask for a place, and a division takes longer than all the rest: one for each quotient,
 * none for remainders. */
static struct i_place in_servo_ic(uint32_t inside_all) {
  const uint32_t block = inside_all / I_IC_BLOCK, m = block / 2u;
  struct i_place place = {I_GROUP_SERVO, inside_all - block * I_IC_BLOCK, m, 0};
  if (block % 2u != 0u) place.instance = m >= 2u ? m - 2u + GATE_IC_STARRED : GATE_IC_COUNT; /* there is no 0* or 1* */
  if (place.offset >= 10u) {
    const uint32_t channel = place.offset / 10u;
    place = (struct i_place){I_GROUP_CHANNEL, place.offset - 10u * channel, place.instance, channel - 1u};
  }
  return place;
}

static inline struct i_place single(i_group_t group, uint32_t inside) {
  return (struct i_place){.group = group, .offset = inside};
}

/* A group of `block` numbers to each motor, coordinate system or IC, of which the first has the number `first`. */
static inline struct i_place in_blocks(i_group_t group, uint32_t inside, uint32_t block, uint32_t first) {
  const uint32_t instance = inside / block;
  return (struct i_place){group, inside - instance * block, instance + first, 0};
}

static struct i_place in_macro_ic(uint32_t inside_all) {
  struct i_place place = in_blocks(I_GROUP_MACRO, inside_all, I_IC_BLOCK, GATE_IC_MACRO);
  if (place.offset >= 10u && place.offset < 30u) {
    place.group = I_GROUP_SUPPLEMENTARY;
    place.channel = place.offset >= 20u ? 1u : 0u;
    place.offset -= place.channel != 0u ? 20u : 10u;
  }
  return place;
}

bool i_table_of_geo_pmac(void) { return geo_pmac; }

static bool is_of_geo_pmac(uint32_t number) {
  return number == I_ONLY_SEGMENTATION_TIME || number - I_BASE_SSI <= I_SSI_BLOCK;
}

static struct i_place of_geo_pmac(uint32_t number) {
  if (number == I_ONLY_SEGMENTATION_TIME) return single(I_GROUP_ONLY, ONLY_SEGMENTATION_TIME);
  if (number == I_ONLY_LOOKAHEAD_LENGTH) return single(I_GROUP_ONLY, ONLY_LOOKAHEAD_LENGTH);
  return single(I_GROUP_SSI, number - I_BASE_SSI);
}

/* What is in no group is reserved, as a number of GATHER without a row is. */
struct i_place i_table_place(uint32_t number) {
  if (geo_pmac && is_of_geo_pmac(number)) return of_geo_pmac(number);
  if (number < I_MOTOR_BLOCK) return single(I_GROUP_GLOBAL, number);
  if (number >= I_BASE_TABLE) return single(I_GROUP_TABLE, number - I_BASE_TABLE);
  if (number >= I_SERVO_FIRST) return in_servo_ic(number - I_SERVO_FIRST);
  if (number >= I_BASE_MACRO) return in_macro_ic(number - I_BASE_MACRO);
  if (number < I_ESA_FIRST) return in_blocks(I_GROUP_MOTOR, number - I_MOTOR_BLOCK, I_MOTOR_BLOCK, 1);
  if (number < I_BASE_SYSTEM) return in_blocks(I_GROUP_ESA, number - I_ESA_FIRST, I_ESA_BLOCK, 0);
  if (number < I_BASE_GATHER) return single(I_GROUP_SYSTEM, number - I_BASE_SYSTEM);
  if (number < I_CS_FIRST) return single(I_GROUP_GATHER, number - I_BASE_GATHER);
  if (number < I_CS_FIRST + COORDINATE_SYSTEMS * I_CS_BLOCK)
    return in_blocks(I_GROUP_CS, number - I_CS_FIRST, I_CS_BLOCK, 0);
  return single(I_GROUP_GATHER, RESERVED);
}

struct i_place i_table_next_of_ic(struct i_place place) {
  ++place.offset;
  if (place.offset != 10u) return place;
  switch (place.group) {
    case I_GROUP_SERVO:
      return (struct i_place){I_GROUP_CHANNEL, 0, place.instance, 0};
    case I_GROUP_MACRO:
      return (struct i_place){I_GROUP_SUPPLEMENTARY, 0, place.instance, 0};
    case I_GROUP_SUPPLEMENTARY:
      if (place.channel != 0u) return (struct i_place){I_GROUP_MACRO, 30, place.instance, 0};
      break;
    default:
      break;
  }
  return (struct i_place){place.group, 0, place.instance, place.channel + 1u};
}

const struct i_entry* i_table_entry(struct i_place place) { return &entries[row_of[place.group][place.offset]]; }

const struct i_entry* i_table_row(uint32_t number) { return i_table_entry(i_table_place(number)); }

uint32_t i_table_lock(i_group_t group) {
  static const uint8_t LOCKS[I_GROUP_COUNT] = {
      [I_GROUP_SSI] = 1,     [I_GROUP_MOTOR] = 1, [I_GROUP_ESA] = 1,           [I_GROUP_CS] = 2,
      [I_GROUP_ONLY] = 2,    [I_GROUP_MACRO] = 4, [I_GROUP_SUPPLEMENTARY] = 4, [I_GROUP_SERVO] = 4,
      [I_GROUP_CHANNEL] = 4, [I_GROUP_TABLE] = 8};
  return LOCKS[group];
}

int32_t i_table_integer(const struct i_entry* entry, uint32_t value) {
  const uint32_t mask = (1u << entry->bits) - 1u, bits = value & mask;
  const bool negative = entry->kind == I_KIND_S && (bits >> (entry->bits - 1u)) != 0u;
  return (int32_t)(negative ? bits | ~mask : bits);
}

double i_table_value(const struct i_entry* entry, double value) {
  if (entry->kind == I_KIND_F) return float48_unpack(float48_pack(value));
  return i_table_integer(entry, (uint32_t)math_nearest(value));
}
