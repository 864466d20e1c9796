/* What stands behind I-variables in the ICs and in the kernel: which bits of which word, and clock directions, which
 * are collected. Written by the background and real-time tasks. */
#include "firmware/variables/i_hardware.h"

#include "firmware/hal/gate_ic.h"
#include "firmware/hal/hal.h"
#include "firmware/kernel/clock_watch.h"
#include "firmware/kernel/tasks.h"
#include "firmware/kernel/watchdog.h"
#include "firmware/variables/i_defaults.h"
#include "firmware/variables/ssi_inputs.h"

static uint32_t directions_pending;       /* bit per IC: direction written, not yet in the IC */
static uint8_t directions[GATE_IC_COUNT]; /* what was written */

void i_hardware_initialize(void) { directions_pending = 0; }

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
      clock_watch_changed();
      break;
    case I_FIELD_IC_PHASE_DIVIDER:
      gate_ic_set_field(ic, GATE_WORD_CLOCK, FIELD(CLOCK_FIELD(PHASE_DIVIDER)), value);
      clock_watch_changed();
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
    case I_FIELD_IC_CLOCK_DIRECTION:
      directions[ic] = (uint8_t)value;
      directions_pending |= 1u << ic;
      break;
    case I_FIELD_IC_CHANNEL:
      gate_ic_set_channel_field(ic, place.channel, channel_fields[place.offset].lsb, channel_fields[place.offset].width,
                                value);
      break;
    default:
      break;
  }
}

void i_hardware_write(struct i_place place, const struct i_entry* entry, uint32_t value) {
  if (i_of_gate_ic(place)) return write_ic(place, entry, value);
  if (entry->field == I_FIELD_REAL_TIME_PERIOD) tasks_set_real_time_period(value);
  if (entry->field == I_FIELD_WATCHDOG_RELOAD) watchdog_set_reload(value);
  if (entry->field == I_FIELD_SSI) ssi_inputs_set(place.offset, value);
}

/* Two ICs must never drive PHASE and SERVO together: every input first, the output when none drives any more. */
void i_hardware_apply_clock_directions(void) {
  if (directions_pending == 0u) return;
  const uint32_t state = hal_mask_real_time();
  const uint32_t pending = directions_pending;
  directions_pending = 0;
  hal_unmask(state);
  for (unsigned output = 0; output < 2u; ++output) {
    if (output != 0u) gate_ic_await_release();
    for (unsigned ic = 0; ic < GATE_IC_COUNT; ++ic) {
      const uint32_t direction = directions[ic];
      if (((pending >> ic) & 1u) != 0u && (direction != gate_ic_direction_inputs(ic)) == (output != 0u))
        gate_ic_set_field(ic, GATE_WORD_CLOCK, FIELD(CLOCK_FIELD(PHASE_EXTERNAL) | CLOCK_FIELD(SERVO_EXTERNAL)),
                          direction);
    }
  }
  clock_watch_changed();
}
