/* Factory defaults. Most are numbers in i_variables.def; these depend on the ICs found, the card or the motor's number.
 */
#include "firmware/variables/i_defaults.h"

#include "firmware/base/buffers_end.h"
#include "firmware/hal/gate_ic.h"
#include "firmware/hal/hal.h"

#define CONVERSION_RESULTS 0x3501u /* result of line 0 of the encoder conversion table */
#define CS_REGISTERS 0x2000u

/* firmware:1.11 */
#define MACRO_NODES 0x20u          /* of a MACRO IC, from its base */
#define MACRO_NOTHING 0x35E5u      /* output and flags of motors without a node */
#define MACRO_FLAGS 0x3440u        /* copies of the nodes' flags */
#define MACRO_NO_FEEDBACK 0x3521u  /* feedback of motors without a line */
#define MACRO_FLAG_MODE 0x040001u  /* flags come over MACRO */
#define MACRO_CONVERSION 0x280000u /* a line that takes a node's word as it is */
#define MACRO_CONVERSION_BITS 0x018000u
#define MACRO_RING_CONTROL 0x4000u
#define MULTIPLEXED_ADC 0x078800u
enum { MACRO_MOTORS = 8, MACRO_FEEDBACK_MOTORS = 16 };

bool i_of_gate_ic(struct i_place place) { return place.group >= I_GROUP_MACRO && place.group <= I_GROUP_CHANNEL; }

bool i_of_absent_ic(struct i_place place) {
  if (!i_of_gate_ic(place)) return false;
  return !gate_ic_present(place.instance) ||
         (place.group == I_GROUP_SUPPLEMENTARY && gate_ic_is_macrogate(place.instance));
}

static bool can_be_source(unsigned ic) { return gate_ic_present(ic) && !gate_ic_is_macrogate(ic); }

/* servo-ic:7.1/3: servo IC 0, MACRO IC 0, servo IC 1..9, 2*..9*, MACRO IC 1..3. */
uint32_t i_default_clock_source(void) {
  if (can_be_source(0)) return gate_ic_direction_variable(0);
  if (can_be_source(GATE_IC_MACRO)) return gate_ic_direction_variable(GATE_IC_MACRO);
  for (unsigned ic = 1; ic < GATE_IC_COUNT; ++ic)
    if (can_be_source(ic)) return gate_ic_direction_variable(ic);
  return 0;
}

uint32_t i_clock_direction(unsigned ic, uint32_t clock_source) {
  return gate_ic_direction_variable(ic) == clock_source && can_be_source(ic) ? 0u : gate_ic_direction_inputs(ic);
}

/* Channels are counted through the servo ICs that are present, four each. Returns the first address, 0 when there is
 * none. */
static uint32_t channel_base(uint32_t channel) {
  uint32_t skip = channel / GATE_IC_CHANNELS;
  for (unsigned ic = 0; ic < GATE_IC_MACRO; ++ic) {
    if (!gate_ic_present(ic)) continue;
    if (skip == 0u) return gate_ic_base(ic) + 8u * (channel % GATE_IC_CHANNELS);
    --skip;
  }
  return 0;
}

/* Without a servo IC the first eight motors are on the nodes of MACRO IC 0 that carry motors, two of four of them. The
 * addresses of the others lead to registers that stay zero. */
static bool motors_on_macro_ic(void) {
  return (gate_ic_found() & ((1u << GATE_IC_MACRO) - 1u)) == 0u && gate_ic_present(GATE_IC_MACRO);
}

static uint32_t macro_node(uint32_t motor) { /* 0..7 */
  return gate_ic_base(GATE_IC_MACRO) + MACRO_NODES + 4u * motor;
}

/* `offset` into the registers of the channel, of which a node has the command output only. */
static uint32_t motor_address(uint32_t motor, uint32_t offset) {
  if (motors_on_macro_ic()) return motor <= MACRO_MOTORS ? macro_node(motor - 1u) : MACRO_NOTHING;
  const uint32_t base = channel_base(motor - 1u);
  return base == 0u ? 0u : base + offset;
}

static uint32_t motor_flags(uint32_t motor) {
  if (!motors_on_macro_ic() || motor > MACRO_MOTORS) return motor_address(motor, 0);
  return MACRO_FLAGS + 4u * ((motor - 1u) / 2u) + (motor - 1u) % 2u;
}

/* A line of the conversion table takes one word of a channel, two of a node: source with its form, then bits. */
static uint32_t motor_feedback(uint32_t motor) {
  if (!motors_on_macro_ic()) return CONVERSION_RESULTS - 1u + motor;
  return motor <= MACRO_FEEDBACK_MOTORS ? CONVERSION_RESULTS - 1u + 2u * motor : MACRO_NO_FEEDBACK;
}

static uint32_t conversion_line(uint32_t line) {
  if (!motors_on_macro_ic()) return channel_base(line);
  if (line >= 2u * MACRO_MOTORS) return 0;
  return line % 2u == 0u ? MACRO_CONVERSION | macro_node(line / 2u) : MACRO_CONVERSION_BITS;
}

static uint32_t macro_base(uint32_t position) {
  for (unsigned ic = GATE_IC_MACRO; ic < GATE_IC_COUNT; ++ic) {
    if (!gate_ic_present(ic)) continue;
    if (position == 0u) return gate_ic_base(ic);
    --position;
  }
  return 0;
}

/* I4900: bits 0..9 servo IC 0..9, 10..19 servo IC 0*..9*. */
static uint32_t servo_ics(void) {
  const uint32_t found = gate_ic_found();
  return (found & 0x3FFu) | (((found >> GATE_IC_STARRED) & 0xFFu) << 12);
}

static double configuration(uint32_t offset) {
  const uint32_t macro_ics = gate_ic_found() >> GATE_IC_MACRO;
  const uint32_t card = hal_strap(HAL_STRAP_CARD);
  switch (offset) {
    case 0:
    case 1:
      return servo_ics(); /* every one is PMAC2-style, type 1 */
    case 2:
      return macro_ics;
    case 3:
      return macro_ics & ~(gate_ic_macrogates() >> GATE_IC_MACRO); /* 1 = DSPGATE2, 0 = MACROGATE */
    case 4:
      return hal_strap(HAL_STRAP_DPRAM_WORDS) != 0u ? 1.0 : 0.0;
    case 8:
      return memory_buffers_end();
    /* Vendor 1 in bits 0..7, no options, revision 1 in bits 18..21, card number less 600000 in bits 22..35. */
    case 9:
      return 1.0 + 262144.0 + 4194304.0 * (card >= 600000u ? card - 600000u : card);
    default:
      return 0.0;
  }
}

bool i_default_is_of_instance(uint32_t field) {
  return (field >= I_FIELD_MOTOR_ACTIVE && field <= I_FIELD_MOTOR_PHASE) || field == I_FIELD_TIME_BASE ||
         field == I_FIELD_IC_CLOCK_DIRECTION || field == I_FIELD_IC_RING_CONTROL;
}

double i_default_value(struct i_place place, const struct i_entry* entry, uint32_t clock_source) {
  if (i_of_absent_ic(place)) return 0.0;
  switch (entry->field) {
    case I_FIELD_CLOCK_SOURCE:
      return clock_source;
    case I_FIELD_MACRO_BASE:
      return macro_base(place.offset - 20u);
    case I_FIELD_DPRAM_BASE:
      return hal_strap(HAL_STRAP_DPRAM_WORDS) != 0u ? DPRAM_BASE : 0u;
    case I_FIELD_MOTOR_ACTIVE:
      return place.instance == 1u ? 1.0 : 0.0;
    case I_FIELD_MOTOR_OUTPUT:
      return motor_address(place.instance, 2);
    case I_FIELD_MOTOR_FEEDBACK:
      return motor_feedback(place.instance);
    case I_FIELD_MOTOR_FLAGS:
      return motor_flags(place.instance);
    case I_FIELD_MOTOR_FLAG_MODE:
      if (!motors_on_macro_ic()) return entry->value;
      return place.instance <= MACRO_FEEDBACK_MOTORS ? MACRO_FLAG_MODE : 0u;
    case I_FIELD_MOTOR_PHASE:
      return motor_address(place.instance, 1);
    case I_FIELD_CONFIGURATION:
      return configuration(place.offset);
    case I_FIELD_TIME_BASE:
      return CS_REGISTERS + 0x100u * place.instance;
    case I_FIELD_CONVERSION:
      return conversion_line(place.offset);
    case I_FIELD_ADC_RING:
      return motors_on_macro_ic() ? MULTIPLEXED_ADC : 0u;
    case I_FIELD_IC_RING_CONTROL:
      return motors_on_macro_ic() && place.instance == GATE_IC_MACRO ? MACRO_RING_CONTROL : 0u;
    case I_FIELD_IC_CLOCK_DIRECTION:
      return i_clock_direction(place.instance, clock_source);
    case I_FIELD_IC_CHANNEL:
      return place.channel == 0u && place.offset == 1u ? 1.0 : entry->value;
    default:
      return entry->value;
  }
}
