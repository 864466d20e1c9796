/* The I-variable table as constant data, with an index by group and number so that a look-up takes no search. */
#include "firmware/variables/i_table.h"

#include "firmware/hal/gate_ic.h"

enum { FORMAT_D = 0, FORMAT_H = 1 };

static const struct i_entry entries[] = {
    {0, 0, 0, I_KIND_S, 24, 0, I_FIELD_NONE, 0.0}, /* reserved numbers */
#define I_ENTRY(name, group, first, count, kind, bits, format, value, field) \
  {I_GROUP_##group, first, count, I_KIND_##kind, bits, FORMAT_##format, I_FIELD_##field, value},
#include "firmware/variables/i_variables.def"
#undef I_ENTRY
};

enum { ENTRY_COUNT = sizeof entries / sizeof entries[0], WIDEST_GROUP = 192 };

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

struct i_place i_table_place(uint32_t number) {
  struct i_place place = {I_GROUP_GLOBAL, number, 0, 0};
  if (number < 100u) return place;
  if (number < 3300u) {
    place = (struct i_place){I_GROUP_MOTOR, number % 100u, number / 100u, 0};
  } else if (number < 4900u) {
    place = (struct i_place){I_GROUP_ESA, number % 50u, (number - 3300u) / 50u, 0};
  } else if (number < 5000u) {
    place = (struct i_place){I_GROUP_SYSTEM, number - 4900u, 0, 0};
  } else if (number < 5100u) {
    place = (struct i_place){I_GROUP_GATHER, number - 5000u, 0, 0};
  } else if (number < 6700u) {
    place = (struct i_place){I_GROUP_CS, number % 100u, (number - 5100u) / 100u, 0};
  } else if (number < 6800u) {
    place = (struct i_place){I_GROUP_GATHER, 99, 0, 0}; /* reserved */
  } else if (number < 7000u) {
    place = in_macro_ic(number);
  } else if (number < 8000u) {
    place = in_servo_ic(number);
  } else {
    place = (struct i_place){I_GROUP_TABLE, number - 8000u, 0, 0};
  }
  return place;
}

const struct i_entry* i_table_entry(struct i_place place) { return &entries[row_of[place.group][place.offset]]; }

const struct i_entry* i_table_row(uint32_t number) { return i_table_entry(i_table_place(number)); }
