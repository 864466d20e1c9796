/* I-variables: values, range reduction, the lock of I41 and the hardware fields behind them.
 * Written by the background and real-time tasks; a double is two stores, so the real-time task is held off meanwhile.
 */
#include "firmware/variables/i_variables.h"

#include "firmware/base/dimensions.h"
#include "firmware/base/mathematics.h"
#include "firmware/hal/gate_ic.h"
#include "firmware/hal/hal.h"
#include "firmware/kernel/clock_watch.h"
#include "firmware/kernel/tasks.h"
#include "firmware/kernel/watchdog.h"
#include "firmware/variables/i_defaults.h"
#include "firmware/variables/i_table.h"

#define TIMER_LOWEST (-8388608)

static double value_of[VARIABLE_COUNT];
static int32_t integer_of[VARIABLE_COUNT]; /* the same, for tasks that must not use floating point */
static uint32_t timer_start[16][2];        /* servo count when Isx11, Isx12 were written */
static uint32_t directions_pending;        /* bit per IC: direction written, not yet in the IC */

/* Reading ---------------------------------------------------------------------------------------------------------- */

static bool is_timer(uint32_t number) {
  const uint32_t inside = number % 100u;
  return number >= 5111u && number < 6700u && (inside == 11u || inside == 12u);
}

static uint32_t* timer_began(uint32_t number) {
  return &timer_start[(number - I_CS_FIRST) / I_CS_BLOCK][number % I_CS_BLOCK - ISX11_TIMERS];
}

/* A timer is its written value less the servo interrupts since; it stops at the lowest 24-bit number. */
static __attribute__((noinline)) int32_t timer_read(uint32_t number) {
  const uint32_t* began = timer_began(number);
  const uint32_t state = hal_mask_real_time();
  const uint32_t elapsed = tasks_servo_count() - *began;
  const int64_t left = (int64_t)integer_of[number] - (int64_t)elapsed;
  hal_unmask(state);
  return left < TIMER_LOWEST ? TIMER_LOWEST : (int32_t)left;
}

int32_t i_integer(uint32_t number) {
  if (number - I_CS_FIRST >= 1600u || !is_timer(number))
    return integer_of[number]; /* asked for by every task: mostly no division */
  return timer_read(number);
}

double i_variable_read(uint32_t number) {
  if (number >= VARIABLE_COUNT) return 0.0;
  if (is_timer(number)) return timer_read(number);
  const uint32_t state = hal_mask_real_time();
  const double value = value_of[number];
  hal_unmask(state);
  return value;
}

i_format_t i_variable_format(uint32_t number) {
  const struct i_place place = i_table_place(number);
  return i_table_entry(place)->hex != 0u && !i_of_absent_ic(place) ? I_FORMAT_HEX : I_FORMAT_DECIMAL;
}

/* Hardware and kernel ---------------------------------------------------------------------------------------------- */

#define FIELD(mask) \
  __builtin_ctz(mask), __builtin_popcount(mask) /* lsb and width of a field, or of several that are one variable */
#define CHANNEL_FIELD(name) SERVO_CHANNEL_CONTROL_##name##_MASK
#define CLOCK_FIELD(name) SERVO_IC_CLOCK_CONTROL_##name##_MASK /* the same in MACRO ICs */

/* Control-word fields of I7mn0..I7mn9, servo-ic:2.5. */
static const struct {
  uint8_t lsb, width;
} channel_fields[10] = {
    {FIELD(CHANNEL_FIELD(DECODE))},
    {FIELD(CHANNEL_FIELD(COMPARE_CHANNEL))},
    {FIELD(CHANNEL_FIELD(CAPTURE_SOURCE) | CHANNEL_FIELD(INDEX_INVERT) | CHANNEL_FIELD(FLAG_INVERT))},
    {FIELD(CHANNEL_FIELD(FLAG_SELECT))},
    {FIELD(CHANNEL_FIELD(GATED_INDEX))},
    {FIELD(CHANNEL_FIELD(GATE_STATE) | CHANNEL_FIELD(INDEX_DEMUX))},
    {FIELD(CHANNEL_FIELD(AB_DAC) | CHANNEL_FIELD(C_PFM))},
    {FIELD(CHANNEL_FIELD(AB_INVERT) | CHANNEL_FIELD(C_INVERT))},
    {FIELD(CHANNEL_FIELD(PFM_DIR_INVERT))},
    {FIELD(CHANNEL_FIELD(HARDWARE_1T))},
};

static void write_ic(struct i_place place, const struct i_entry* entry, uint32_t value) {
  const unsigned ic = place.instance;
  switch (entry->field) {
    case I_FIELD_IC_MAX_PHASE:
      gate_ic_set_field(ic, GATE_WORD_PWM, FIELD(SERVO_IC_PWM_CONTROL_MAX_COUNT_MASK), value);
      break;
    case I_FIELD_IC_PHASE_DIVIDER:
      gate_ic_set_field(ic, GATE_WORD_CLOCK, FIELD(CLOCK_FIELD(PHASE_DIVIDER)), value);
      break;
    case I_FIELD_IC_SERVO_DIVIDER:
      gate_ic_set_field(ic, GATE_WORD_CLOCK, FIELD(CLOCK_FIELD(SERVO_DIVIDER)), value);
      break;
    case I_FIELD_IC_HARDWARE_CLOCKS:
      gate_ic_set_field(ic, GATE_WORD_CLOCK,
                        FIELD(CLOCK_FIELD(SCLK_DIVIDER) | CLOCK_FIELD(PFM_DIVIDER) | CLOCK_FIELD(DAC_DIVIDER) |
                              CLOCK_FIELD(ADC_DIVIDER)),
                        value);
      break;
    case I_FIELD_IC_DEAD_TIME:
      gate_ic_set_field(ic, GATE_WORD_PWM, FIELD(SERVO_IC_PWM_CONTROL_DEADTIME_MASK), value);
      break;
    case I_FIELD_IC_DAC_STROBE:
      gate_ic_set_word(ic, GATE_WORD_DAC_STROBE, value);
      break;
    case I_FIELD_IC_ADC_STROBE:
      gate_ic_set_word(ic, GATE_WORD_ADC_STROBE, value);
      break;
    case I_FIELD_IC_RING_CONTROL:
      gate_ic_set_word(ic, GATE_WORD_RING_CONTROL, value);
      break;
    case I_FIELD_IC_NODE_ACTIVATION:
      gate_ic_set_word(ic, GATE_WORD_NODE_ACTIVATION, value);
      break;
    case I_FIELD_IC_CHANNEL:
      gate_ic_set_channel_field(ic, place.channel, channel_fields[place.offset].lsb, channel_fields[place.offset].width,
                                value);
      break;
    default:
      break;
  }
}

static void write_kernel(const struct i_entry* entry, uint32_t value) {
  if (entry->field == I_FIELD_REAL_TIME_PERIOD) tasks_set_real_time_period(value);
  if (entry->field == I_FIELD_WATCHDOG_RELOAD) watchdog_set_reload(value);
}

/* Two ICs must never drive PHASE and SERVO together: every input first, the output when none drives any more. */
void i_variable_apply_clock_directions(void) {
  if (directions_pending == 0u) return;
  const uint32_t state = hal_mask_real_time();
  const uint32_t pending = directions_pending;
  directions_pending = 0;
  hal_unmask(state);
  for (unsigned output = 0; output < 2u; ++output) {
    if (output != 0u) gate_ic_await_release();
    for (unsigned ic = 0; ic < GATE_IC_COUNT; ++ic) {
      const uint32_t direction = (uint32_t)integer_of[gate_ic_direction_variable(ic)];
      if (((pending >> ic) & 1u) != 0u && (direction != gate_ic_direction_inputs(ic)) == (output != 0u))
        gate_ic_set_field(ic, GATE_WORD_CLOCK, FIELD(CLOCK_FIELD(PHASE_EXTERNAL) | CLOCK_FIELD(SERVO_EXTERNAL)),
                          direction);
    }
  }
  clock_watch_changed();
}

/* Writing ---------------------------------------------------------------------------------------------------------- */

static void store(uint32_t number, double value) {
  int32_t whole = INT32_MAX;
  if (value < 2147483647.0) whole = value > -2147483648.0 ? (int32_t)value : INT32_MIN;
  const uint32_t state = hal_mask_real_time();
  value_of[number] = value;
  integer_of[number] = whole;
  hal_unmask(state);
}

/* Limited-range integers never fail: the bits above the range are dropped. */
static int32_t reduce(const struct i_entry* entry, uint32_t value) {
  const uint32_t bits = value & ((1u << entry->bits) - 1u);
  if (entry->kind == I_KIND_S && (bits >> (entry->bits - 1u)) != 0u)
    return (int32_t)(bits | ~((1u << entry->bits) - 1u));
  return (int32_t)bits;
}

static bool locked(uint32_t number) {
  const uint32_t locks = (uint32_t)integer_of[I41_VARIABLE_LOCK];
  if (locks == 0u) return false;
  if (number >= 100u && number < 4900u) return (locks & 1u) != 0u;
  if (number >= 5100u && number < 6700u) return (locks & 2u) != 0u;
  if (number >= 6800u && number < 8000u) return (locks & 4u) != 0u;
  return number >= 8000u && (locks & 8u) != 0u;
}

void i_timer_write(uint32_t number, int32_t value) {
  const uint32_t state = hal_mask_real_time();
  store(number, value);
  *timer_began(number) = tasks_servo_count();
  hal_unmask(state);
}

void i_variable_write(uint32_t number, double value) {
  if (number >= VARIABLE_COUNT || locked(number)) return;
  const struct i_place place = i_table_place(number);
  const struct i_entry* entry = i_table_entry(place);
  if (entry->kind == I_KIND_R) return;
  if (i_of_absent_ic(place)) return;
  if (entry->kind == I_KIND_F) {
    store(number, value);
    return;
  }
  const int32_t whole = reduce(entry, (uint32_t)math_nearest(value));
  const uint32_t state = hal_mask_real_time();
  switch (entry->field) {
    case I_FIELD_CLOCK_SOURCE:
      if (gate_ic_of_direction((uint32_t)whole) == GATE_IC_COUNT)
        break; /* I19 takes numbers of direction variables only */
      store(number, whole);
      break;
    case I_FIELD_TIMER:
      i_timer_write(number, whole);
      break;
    case I_FIELD_IC_CLOCK_DIRECTION:
      store(number, whole & (int32_t)gate_ic_direction_inputs(place.instance));
      directions_pending |= 1u << place.instance;
      break;
    case I_FIELD_IC_CHANNEL:
      if (place.channel == 0u && place.offset == 1u) break; /* channel 1 has its own counter only: reads 1 */
      store(number, whole);
      write_ic(place, entry, (uint32_t)whole);
      break;
    default:
      store(number, whole);
      if (i_of_gate_ic(place)) write_ic(place, entry, (uint32_t)whole);
      write_kernel(entry, (uint32_t)whole);
      break;
  }
  hal_unmask(state);
  if (i_effects[entry->field] != 0) i_effects[entry->field](place.instance);
  if (entry->field == I_FIELD_IC_MAX_PHASE || entry->field == I_FIELD_IC_PHASE_DIVIDER) clock_watch_changed();
}

void i_variable_set_open_memory_end(uint32_t address) { store(I4908_OPEN_MEMORY_END, address); }

/* Start-up --------------------------------------------------------------------------------------------------------- */

double i_variable_default(uint32_t number) {
  const struct i_place place = i_table_place(number);
  const uint32_t source =
      number == I19_CLOCK_SOURCE ? i_default_clock_source() : (uint32_t)integer_of[I19_CLOCK_SOURCE];
  return i_default_value(place, i_table_entry(place), source);
}

static void defaults(uint32_t first, uint32_t count, uint32_t source) {
  for (uint32_t number = first; number < first + count; ++number) {
    const struct i_place place = i_table_place(number);
    const struct i_entry* entry = i_table_entry(place);
    if (entry->field == I_FIELD_NONE && entry->value == 0.0) continue;
    store(number, i_default_value(place, entry, source));
  }
}

/* `copies` more blocks of 100 after the one at `first`: the same, except where the default depends on the motor or
 * coordinate system. Looking every row up for each would double the start-up time. */
static void repeat(uint32_t first, uint32_t copies, uint32_t source) {
  defaults(first, 100, source);
  for (uint32_t block = first + 100u; block < first + 100u * (copies + 1u); block += 100u) {
    __builtin_memcpy(&value_of[block], &value_of[first], 100u * sizeof value_of[0]);
    __builtin_memcpy(&integer_of[block], &integer_of[first], 100u * sizeof integer_of[0]);
  }
  for (uint32_t offset = 0; offset < 100u; ++offset) {
    if (i_table_entry(i_table_place(first + offset))->field == I_FIELD_NONE) continue;
    for (uint32_t block = 1; block <= copies; ++block) defaults(first + offset + 100u * block, 1, source);
  }
}

static void clear_all(void) {
  i_table_initialize();
  __builtin_memset(value_of, 0, sizeof value_of);
  __builtin_memset(integer_of, 0, sizeof integer_of);
  directions_pending = 0;
}

static void ic_defaults(uint32_t ics, uint32_t source) {
  for (unsigned ic = 0; ic < GATE_IC_COUNT; ++ic)
    if (gate_ic_present(ic) && ((ics >> ic) & 1u) != 0u)
      defaults(gate_ic_direction_variable(ic) - I7M07_CLOCK_DIRECTION, 50, source);
}

void i_variable_initialize(void) {
  const uint32_t source = i_default_clock_source();
  clear_all();
  defaults(0, 100, source);
  repeat(100, 31, source);
  defaults(4900, 10, source);
  defaults(I5061_ADC_RING, 16, source);
  repeat(5100, 15, source);
  ic_defaults(~0u, source);
  defaults(8000, 72, source); /* at most 18 servo ICs of four channels */
}

i_kept_t i_variable_kept(uint32_t number) {
  const struct i_entry* entry = i_table_row(number);
  if (entry->kind == I_KIND_R || entry->field == I_FIELD_TIMER || value_of[number] == 0.0) return I_NOT_KEPT;
  return entry->kind == I_KIND_F ? I_KEPT_FLOAT : I_KEPT_INTEGER;
}

bool i_variable_is_early(uint32_t number) {
  return number < I_MOTOR_BLOCK || (number >= I_BASE_MACRO && number < I_BASE_TABLE);
}

void i_variable_begin_restore(uint32_t saved_ics) {
  clear_all();
  defaults(4900, 10, 0);
  ic_defaults(~saved_ics, 0);
}

/* The row of a number that takes a value; else none's, which is read-only. */
static const struct i_entry* row_to_restore(uint32_t number) {
  static const struct i_entry none = {.kind = I_KIND_R};
  if (number >= VARIABLE_COUNT) return &none;
  if (number >= I_BASE_MACRO && i_of_absent_ic(i_table_place(number))) return &none;
  return i_table_row(number);
}

void i_variable_restore_integer(uint32_t number, int32_t value) {
  const struct i_entry* entry = row_to_restore(number);
  if (entry->kind != I_KIND_U && entry->kind != I_KIND_S) return;
  integer_of[number] = reduce(entry, (uint32_t)value);
  value_of[number] = integer_of[number];
}

void i_variable_restore_float(uint32_t number, double value) {
  if (row_to_restore(number)->kind == I_KIND_F && math_is_finite(value)) store(number, value);
}

/* I19 rules at start: its IC drives the clocks, whatever the direction variables were saved as. */
void i_variable_write_hardware(void) {
  tasks_set_real_time_period((uint32_t)i_integer(I8_REAL_TIME_PERIOD));
  watchdog_set_reload((uint32_t)i_integer(I40_WATCHDOG_RELOAD));
  gate_ic_release_clocks();
  for (unsigned ic = 0; ic < GATE_IC_COUNT; ++ic) {
    if (!gate_ic_present(ic)) continue;
    const uint32_t direction = gate_ic_direction_variable(ic);
    store(direction, i_clock_direction(ic, (uint32_t)integer_of[I19_CLOCK_SOURCE]));
    directions_pending |= 1u << ic;
    for (uint32_t number = direction - I7M07_CLOCK_DIRECTION; number < direction + 43u; ++number) {
      const struct i_place place = i_table_place(number);
      if (!i_of_absent_ic(place)) write_ic(place, i_table_entry(place), (uint32_t)integer_of[number]);
    }
  }
  i_variable_apply_clock_directions();
}
