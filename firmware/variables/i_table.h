/* The rows of i_variables.def and how a variable number finds its row. */
#ifndef FIRMWARE_VARIABLES_I_TABLE_H
#define FIRMWARE_VARIABLES_I_TABLE_H

#include <stdbool.h>
#include <stdint.h>

typedef enum {
  I_GROUP_GLOBAL,
  I_GROUP_MOTOR,
  I_GROUP_ESA,
  I_GROUP_SYSTEM,
  I_GROUP_GATHER,
  I_GROUP_CS,
  I_GROUP_MACRO,
  I_GROUP_SUPPLEMENTARY,
  I_GROUP_SERVO,
  I_GROUP_CHANNEL,
  I_GROUP_TABLE,
  I_GROUP_SSI,
  I_GROUP_ONLY,
  I_GROUP_COUNT
} i_group_t;

typedef enum { I_KIND_U, I_KIND_S, I_KIND_F, I_KIND_R } i_kind_t;

typedef enum {
  I_FIELD_NONE,
  I_FIELD_BUFFER_REQUEST,
  I_FIELD_REAL_TIME_PERIOD,
  I_FIELD_WATCHDOG_RELOAD,
  I_FIELD_CLOCK_SOURCE,
  I_FIELD_MACRO_BASE,
  I_FIELD_DPRAM,
  I_FIELD_DPRAM_BASE,
  I_FIELD_MOTOR_ACTIVE,
  I_FIELD_MOTOR_COMMUTATION,
  I_FIELD_MOTOR_OUTPUT,
  I_FIELD_MOTOR_FEEDBACK,
  I_FIELD_MOTOR_FLAGS,
  I_FIELD_MOTOR_FLAG_MODE,
  I_FIELD_MOTOR_PHASE,
  I_FIELD_MOTOR_SERVO,   /* the servo task calculates with it */
  I_FIELD_MOTOR_CURRENT, /* the phase task does */
  I_FIELD_MOTOR_BOTH,
  I_FIELD_CONFIGURATION,
  I_FIELD_TIMER,
  I_FIELD_UNTIL_RESET, /* it is not saved */
  I_FIELD_TIME_BASE,
  I_FIELD_TIME_BASE_SLEW,
  I_FIELD_LOOKAHEAD,
  I_FIELD_SEGMENTATION_TIME, /* one value for all systems of a Geo PMAC */
  I_FIELD_LOOKAHEAD_LENGTH,  /* the same */
  I_FIELD_CONVERSION,
  I_FIELD_VELOCITY_SAMPLES,
  I_FIELD_COMPENSATION,
  I_FIELD_ADC_RING,
  I_FIELD_IC_MAX_PHASE,
  I_FIELD_IC_PHASE_DIVIDER,
  I_FIELD_IC_SERVO_DIVIDER,
  I_FIELD_IC_HARDWARE_CLOCKS,
  I_FIELD_IC_DEAD_TIME,
  I_FIELD_IC_DAC_STROBE,
  I_FIELD_IC_ADC_STROBE,
  I_FIELD_IC_CLOCK_DIRECTION,
  I_FIELD_IC_CHANNEL,
  I_FIELD_IC_RING_CONTROL,
  I_FIELD_IC_NODE_ACTIVATION,
  I_FIELD_IC_SHADOW,
  I_FIELD_SSI,
  I_FIELD_COUNT
} i_field_t;

struct i_entry {
  uint8_t group, first, count, kind, bits, hex, field;
  double value; /* default */
};

/* Where a number stands: group, number inside the group, and which motor (1..32), coordinate system (0..15) or IC
 * (index of hal/gate_ic.h) it belongs to. `channel` 0..3 for the CHANNEL group, 0..1 for SUPPLEMENTARY. */
struct i_place {
  i_group_t group;
  uint32_t offset, instance, channel;
};

void i_table_initialize(void);
struct i_place i_table_place(uint32_t number) __attribute__((noinline)); /* in parts it would be slower */
struct i_place i_table_next_of_ic(struct i_place place); /* of the next number of the same IC, without a division */
bool i_table_of_geo_pmac(void);                          /* this board has I13, I1015 to I1020 of its own */
const struct i_entry* i_table_entry(struct i_place place);
const struct i_entry* i_table_row(uint32_t number); /* both at once */
uint32_t i_table_lock(i_group_t group);             /* the bit of I41 that locks it; 0: none does */
/* What a variable of the row has when `value` is assigned (firmware:1.5): integers never fail, the bits above the range
 * are dropped; a real has the 36 bits that a 48-bit float holds. */
double i_table_value(const struct i_entry* entry, double value);
int32_t i_table_integer(const struct i_entry* entry,
                        uint32_t value); /* the same of an integer, without floating point */

#endif
