/* I-variables: values, the lock of I41, what is saved. Ranges are those of the table (i_table.c).
 * Written by the background and real-time tasks; a double is two stores, so the real-time task is held off meanwhile.
 */
#include "firmware/variables/i_variables.h"

#include "firmware/base/dimensions.h"
#include "firmware/base/mathematics.h"
#include "firmware/hal/gate_ic.h"
#include "firmware/hal/hal.h"
#include "firmware/kernel/tasks.h"
#include "firmware/variables/i_defaults.h"
#include "firmware/variables/i_hardware.h"
#include "firmware/variables/i_table.h"

#define TIMER_LOWEST (-8388608)
#define TIMER_LOOK 256u /* servo interrupts from one look at a timer to the next */
enum { CONFIGURATION_COUNT = I4909_CPU_IDENTIFICATION + 1 - I_BASE_SYSTEM }; /* the others are 0 */

static double value_of[VARIABLE_COUNT];
int32_t i_integers[VARIABLE_COUNT]; /* the same, for tasks that must not use floating point */
static uint32_t timer_start[COORDINATE_SYSTEMS][ISX11_TIMERS_COUNT]; /* servo count when Isx11, Isx12 were written */

/* Reading ---------------------------------------------------------------------------------------------------------- */

static bool is_timer(uint32_t number) {
  const uint32_t of_systems = number - I_CS_FIRST; /* asked for by every task: mostly no division */
  return of_systems < I_CS_BLOCK * COORDINATE_SYSTEMS && of_systems % I_CS_BLOCK - ISX11_TIMERS < ISX11_TIMERS_COUNT;
}

static uint32_t* timer_began(uint32_t number) {
  return &timer_start[(number - I_CS_FIRST) / I_CS_BLOCK][number % I_CS_BLOCK - ISX11_TIMERS];
}

/* A timer is its written value less the servo interrupts since; it stops at the lowest 24-bit number. */
static __attribute__((noinline)) int32_t timer_read(uint32_t number) {
  const uint32_t* began = timer_began(number);
  const uint32_t state = hal_mask_real_time();
  const uint32_t elapsed = tasks_servo_count() - *began;
  const int64_t left = (int64_t)i_integers[number] - (int64_t)elapsed;
  hal_unmask(state);
  return left < TIMER_LOWEST ? TIMER_LOWEST : (int32_t)left;
}

int32_t i_integer_of(uint32_t number) { return is_timer(number) ? timer_read(number) : i_integers[number]; }

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

/* Writing ---------------------------------------------------------------------------------------------------------- */

static void store(uint32_t number, double value) {
  int32_t whole = INT32_MAX;
  if (value < 2147483647.0) whole = value > -2147483648.0 ? (int32_t)value : INT32_MIN;
  const uint32_t state = hal_mask_real_time();
  value_of[number] = value;
  i_integers[number] = whole;
  hal_unmask(state);
}

void i_timer_write(uint32_t number, int32_t value) {
  const uint32_t state = hal_mask_real_time();
  store(number, value);
  *timer_began(number) = tasks_servo_count();
  hal_unmask(state);
}

/* One at a time. */
void i_timers_pass(void) {
  static uint32_t turn, looked; /* B */
  const uint32_t now = tasks_servo_count();
  if (now - looked < TIMER_LOOK) return;
  looked = now;
  const uint32_t number = i_cs(turn / ISX11_TIMERS_COUNT, ISX11_TIMERS) + turn % ISX11_TIMERS_COUNT;
  const uint32_t state = hal_mask_real_time();
  if (timer_read(number) == TIMER_LOWEST) i_timer_write(number, TIMER_LOWEST);
  hal_unmask(state);
  turn = (turn + 1u) % (COORDINATE_SYSTEMS * ISX11_TIMERS_COUNT);
}

/* I19 takes numbers of direction variables only; channel 1 has its own counter only. */
static bool is_refused(struct i_place place, const struct i_entry* entry, uint32_t value) {
  if (entry->field == I_FIELD_CLOCK_SOURCE) return gate_ic_of_direction(value) == GATE_IC_COUNT;
  return entry->field == I_FIELD_IC_CHANNEL && place.channel == 0u && place.offset == I7MN1_COMPARE_CHANNEL;
}

/* Iyy10 to Iyy39 take something while Iyy00 is 1, and are 0 from its end on. */
static bool is_of_extended_servo_off(struct i_place place) {
  return place.group == I_GROUP_ESA && place.offset - IYY10_EXTENDED_SERVO_GAINS < IYY10_EXTENDED_SERVO_GAINS_COUNT &&
         i_integers[i_esa(place.instance + 1u, IYY00_EXTENDED_SERVO)] == 0;
}

static void clear_extended_servo(uint32_t motor) {
  const uint32_t first = i_esa(motor + 1u, IYY00_EXTENDED_SERVO) + IYY10_EXTENDED_SERVO_GAINS;
  for (uint32_t number = first; number < first + IYY10_EXTENDED_SERVO_GAINS_COUNT; ++number) store(number, 0.0);
}

/* Whether a write does anything now. */
static bool is_open(struct i_place place, const struct i_entry* entry) {
  if (entry->kind == I_KIND_R || i_of_absent_ic(place)) return false;
  if (is_of_extended_servo_off(place)) return false;
  return (i_table_lock(place.group) & (uint32_t)i_integers[I41_VARIABLE_LOCK]) == 0u;
}

/* On a Geo PMAC I13 is Isx13 and I1020 Isx20 of every system (firmware:3.8): one value, under all its numbers. */
static void share(const struct i_entry* entry, double value) {
  if (entry->field != I_FIELD_SEGMENTATION_TIME && entry->field != I_FIELD_LOOKAHEAD_LENGTH) return;
  if (!i_table_of_geo_pmac()) return;
  const bool is_time = entry->field == I_FIELD_SEGMENTATION_TIME;
  store(is_time ? I_ONLY_SEGMENTATION_TIME : I_ONLY_LOOKAHEAD_LENGTH, value);
  for (uint32_t cs = 0; cs < COORDINATE_SYSTEMS; ++cs)
    store(i_cs(cs, is_time ? ISX13_SEGMENTATION_TIME : ISX20_LOOKAHEAD_LENGTH), value);
}

bool i_variable_foreground_in_position(void) {
  return i_integer(I13_FOREGROUND_IN_POSITION) != 0 && !i_table_of_geo_pmac();
}

void i_variable_write(uint32_t number, double value) {
  if (number >= VARIABLE_COUNT) return;
  const struct i_place place = i_table_place(number);
  const struct i_entry* entry = i_table_entry(place);
  if (!is_open(place, entry)) return;
  double taken = i_table_value(entry, value);
  if (is_refused(place, entry, entry->kind == I_KIND_F ? 0u : (uint32_t)(int32_t)taken)) return;
  if (entry->field == I_FIELD_IC_CLOCK_DIRECTION)
    taken = (int32_t)taken & (int32_t)gate_ic_direction_inputs(place.instance);
  const uint32_t state = hal_mask_real_time();
  if (entry->field == I_FIELD_TIMER)
    i_timer_write(number, (int32_t)taken);
  else
    store(number, taken);
  share(entry, taken);
  if (place.group == I_GROUP_ESA && place.offset == IYY00_EXTENDED_SERVO && taken == 0.0)
    clear_extended_servo(place.instance);
  i_hardware_write(place, entry, (uint32_t)i_integers[number]);
  hal_unmask(state);
  if (i_effects[entry->field] != 0) i_effects[entry->field](place.instance);
}

void i_variable_write_part(uint32_t number, uint32_t mask, uint32_t bits) {
  const struct i_place place = i_table_place(number);
  const struct i_entry* entry = i_table_entry(place);
  if (!is_open(place, entry)) return;
  const uint32_t state = hal_mask_real_time();
  store(number, i_table_integer(entry, ((uint32_t)i_integers[number] & ~mask) | bits));
  hal_unmask(state);
  if (i_effects[entry->field] != 0) i_effects[entry->field](place.instance);
}

void i_variable_set_lookahead_state(uint32_t cs, uint32_t state) { store(i_cs(cs, ISX21_LOOKAHEAD_STATE), state); }

void i_variable_set_open_memory_end(uint32_t address) { store(I4908_OPEN_MEMORY_END, address); }

enum { I4904_MEMORY = I4900_SERVO_ICS + 4, FIRST_LOCK = 4, LOCKS = 0xFF };

uint32_t i_variable_locks(void) { return (uint32_t)i_integers[I4904_MEMORY] >> FIRST_LOCK & LOCKS; }

void i_variable_set_locks(uint32_t locks) {
  const uint32_t others = (uint32_t)i_integers[I4904_MEMORY] & ~((uint32_t)LOCKS << FIRST_LOCK);
  store(I4904_MEMORY, others | locks << FIRST_LOCK);
}

/* Start-up --------------------------------------------------------------------------------------------------------- */

double i_variable_default(uint32_t number) {
  const struct i_place place = i_table_place(number);
  const uint32_t source =
      number == I19_CLOCK_SOURCE ? i_default_clock_source() : (uint32_t)i_integers[I19_CLOCK_SOURCE];
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

static void copy(uint32_t from, uint32_t to, uint32_t count) {
  __builtin_memcpy(&value_of[to], &value_of[from], count * sizeof value_of[0]);
  __builtin_memcpy(&i_integers[to], &i_integers[from], count * sizeof i_integers[0]);
}

/* `copies` more blocks of 100 after the one at `first`: the same, except where the default depends on the motor or
 * coordinate system. Looking every row up for each would double the start-up time. */
static void repeat(uint32_t first, uint32_t copies, uint32_t source) {
  defaults(first, 100, source);
  for (uint32_t block = first + 100u; block < first + 100u * (copies + 1u); block += 100u) copy(first, block, 100);
  for (uint32_t offset = 0; offset < 100u; ++offset) {
    if (!i_default_is_of_instance(i_table_row(first + offset)->field)) continue;
    for (uint32_t block = 1; block <= copies; ++block) defaults(first + offset + 100u * block, 1, source);
  }
}

/* The first time all is 0 already, and a start with 22 ICs has no 0.3 ms to spare. */
static void clear_all(void) {
  static bool used;
  i_table_initialize();
  if (used) {
    __builtin_memset(value_of, 0, sizeof value_of);
    __builtin_memset(i_integers, 0, sizeof i_integers);
    __builtin_memset(timer_start, 0, sizeof timer_start); /* the servo count begins anew too */
  }
  used = true;
  i_hardware_initialize();
}

/* Servo ICs have the defaults of the first one that is there, but for what is each one's own. */
static void ic_defaults(uint32_t ics, uint32_t source) {
  uint32_t like = 0;
  for (unsigned ic = 0; ic < GATE_IC_COUNT; ++ic) {
    if (!gate_ic_present(ic) || ((ics >> ic) & 1u) == 0u) continue;
    const uint32_t first = gate_ic_direction_variable(ic) - I7M07_CLOCK_DIRECTION;
    if (ic >= GATE_IC_MACRO || like == 0u) {
      defaults(first, I_IC_BLOCK, source);
      if (ic < GATE_IC_MACRO) like = first;
      continue;
    }
    copy(like, first, I_IC_BLOCK);
    for (uint32_t offset = 0; offset < 10u; ++offset) /* the channels' are all the same */
      if (i_default_is_of_instance(i_table_row(first + offset)->field)) defaults(first + offset, 1, source);
  }
}

void i_variable_initialize(void) {
  const uint32_t source = i_default_clock_source();
  clear_all();
  defaults(I_BASE_GLOBAL, I_MOTOR_BLOCK, source);
  repeat(i_motor(1, 0), MOTORS - 1, source);
  if (i_table_of_geo_pmac()) defaults(I_BASE_SSI, I_SSI_BLOCK + 1u, source);
  defaults(I_BASE_SYSTEM, CONFIGURATION_COUNT, source);
  defaults(I5061_ADC_RING, I5061_ADC_RING_COUNT, source);
  repeat(I_CS_FIRST, COORDINATE_SYSTEMS - 1, source);
  ic_defaults(~0u, source);
  defaults(I_BASE_TABLE, GATE_IC_MACRO * GATE_IC_CHANNELS, source); /* a line each channel of the servo ICs */
}

static bool is_state(i_field_t field) {
  return field == I_FIELD_TIMER || field == I_FIELD_UNTIL_RESET || field == I_FIELD_LOOKAHEAD;
}

i_kept_t i_variable_kept(uint32_t number) {
  const struct i_entry* entry = i_table_row(number);
  if (entry->kind == I_KIND_R || is_state(entry->field) || value_of[number] == 0.0) return I_NOT_KEPT;
  return entry->kind == I_KIND_F ? I_KEPT_FLOAT : I_KEPT_INTEGER;
}

bool i_variable_is_early(uint32_t number) {
  return number < I_MOTOR_BLOCK || (number >= I_BASE_MACRO && number < I_BASE_TABLE);
}

void i_variable_begin_restore(uint32_t saved_ics) {
  clear_all();
  defaults(I_BASE_SYSTEM, CONFIGURATION_COUNT, 0);
  ic_defaults(~saved_ics, 0);
}

/* The row of a number that takes a value; else none's, which is read-only. */
static const struct i_entry* row_to_restore(uint32_t number) {
  static const struct i_entry none = {.kind = I_KIND_R};
  if (number >= VARIABLE_COUNT) return &none;
  const struct i_place place = i_table_place(number);
  const bool of_ic = number >= I_BASE_MACRO && number < I_BASE_TABLE; /* only those are asked: a start has 2,000 */
  return of_ic && i_of_absent_ic(place) ? &none : i_table_entry(place);
}

void i_variable_restore_integer(uint32_t number, int32_t value) {
  const struct i_entry* entry = row_to_restore(number);
  if (entry->kind != I_KIND_U && entry->kind != I_KIND_S) return;
  i_integers[number] = i_table_integer(entry, (uint32_t)value);
  value_of[number] = i_integers[number];
}

void i_variable_restore_float(uint32_t number, double value) {
  const struct i_entry* entry = row_to_restore(number);
  if (entry->kind == I_KIND_F && math_is_finite(value)) store(number, i_table_value(entry, value));
}

/* I19 rules at start: its IC drives the clocks, whatever the direction variables were saved as. */
static void write_ic(unsigned ic) {
  const uint32_t direction = gate_ic_direction_variable(ic), first = direction - I7M07_CLOCK_DIRECTION;
  store(direction, i_clock_direction(ic, (uint32_t)i_integers[I19_CLOCK_SOURCE]));
  struct i_place place = i_table_place(first);
  for (uint32_t number = first; number < first + I_IC_BLOCK; ++number, place = i_table_next_of_ic(place)) {
    if (!i_of_absent_ic(place)) i_hardware_write(place, i_table_entry(place), (uint32_t)i_integers[number]);
  }
}

void i_variable_write_ssi(void) {
  for (uint32_t number = I_BASE_SSI; number < I_BASE_SSI + I_SSI_BLOCK && i_table_of_geo_pmac(); ++number)
    i_hardware_write(i_table_place(number), i_table_row(number), (uint32_t)i_integers[number]);
}

void i_variable_write_hardware(void) {
  for (uint32_t number = I_BASE_GLOBAL; number < I_MOTOR_BLOCK; ++number)
    i_hardware_write(i_table_place(number), i_table_row(number), (uint32_t)i_integers[number]);
  gate_ic_release_clocks();
  for (unsigned ic = 0; ic < GATE_IC_COUNT; ++ic)
    if (gate_ic_present(ic)) write_ic(ic);
  i_hardware_apply_clock_directions();
}
