/* Servo ICs and MACRO ICs on the expansion bus. Shadows hold the fields of I-variables; they are owned by the
 * background and real-time tasks, and the servo task is held off because it switches amplifier enables in the same
 * words. */
#include "firmware/hal/gate_ic.h"

#include "firmware/hal/hal.h"

static const uint32_t bases[GATE_IC_COUNT] = GATE_IC_BASES;
static const uint32_t direction_variables[GATE_IC_COUNT] = GATE_IC_DIRECTION_VARIABLES;

struct gate_ic {
  uint32_t clock, pwm, channel[GATE_IC_CHANNELS];
};

static struct gate_ic shadow[GATE_IC_COUNT];
static uint32_t found, macrogates;

uint32_t gate_ic_base(unsigned ic) { return bases[ic]; }
uint32_t gate_ic_direction_variable(unsigned ic) { return direction_variables[ic]; }

unsigned gate_ic_of_direction(uint32_t variable) {
  unsigned ic = 0;
  while (ic < GATE_IC_COUNT && gate_ic_direction_variable(ic) != variable) ++ic;
  return ic;
}

/* Bits of a channel's control word that others switch while the machine runs, M-variables among them. No I-variable has
 * them, so no shadow does: a field write takes them from the IC. EQU write falls back by itself. */
#define CHANNEL_LIVE_BITS \
  (SERVO_CHANNEL_CONTROL_COUNTER_RESET_MASK | SERVO_CHANNEL_CONTROL_EQU_STATE_MASK | SERVO_CHANNEL_CONTROL_AENA_MASK)

/* Clock word and PWM word: the same layout in both kinds of IC. */
#define PHASE_INPUT ((uint32_t)CLOCK_DIRECTION_INPUT << SERVO_IC_CLOCK_CONTROL_PHASE_EXTERNAL_SHIFT)
#define SERVO_INPUT ((uint32_t)CLOCK_DIRECTION_INPUT << SERVO_IC_CLOCK_CONTROL_SERVO_EXTERNAL_SHIFT)
#define FIELD_OF(word, name) (((word)&name##_MASK) >> name##_SHIFT)

static uint32_t strobe_address(unsigned ic) {
  return gate_ic_base(ic) + (ic >= GATE_IC_MACRO ? MACRO_IC_X_ADC_STROBE : SERVO_IC_X_ADC_STROBE);
}

/* Two patterns, so that neither a floating bus nor a stuck word can pass. `bits` exist in the word. */
static bool answers(uint32_t address, uint32_t bits) {
  const uint32_t before = *hal_x(address) & HAL_WORD_MASK;
  *hal_x(address) = 0x5A3C96u & bits;
  bool good = (*hal_x(address) & HAL_WORD_MASK) == (0x5A3C96u & bits);
  *hal_x(address) = 0xA5C368u & bits;
  good = good && (*hal_x(address) & HAL_WORD_MASK) == (0xA5C368u & bits);
  *hal_x(address) = before;
  return good;
}

uint32_t gate_ic_found(void) { return found; }
uint32_t gate_ic_macrogates(void) { return macrogates; }
uint32_t gate_ic_configuration(void) { return found | (macrogates >> GATE_IC_MACRO) << 24; }
bool gate_ic_is_macrogate(unsigned ic) { return ((macrogates >> ic) & 1u) != 0u; }
/* The direction bits of the clock word that make both clocks inputs. */
static uint32_t inputs_of(unsigned ic) { return gate_ic_is_macrogate(ic) ? PHASE_INPUT : PHASE_INPUT | SERVO_INPUT; }
uint32_t gate_ic_direction_inputs(unsigned ic) { return inputs_of(ic) >> SERVO_IC_CLOCK_CONTROL_PHASE_EXTERNAL_SHIFT; }
bool gate_ic_present(unsigned ic) { return ic < GATE_IC_COUNT && ((found >> ic) & 1u) != 0u; }

static uint32_t* shadow_of(unsigned ic, gate_word_t word, unsigned channel) {
  switch (word) {
    case GATE_WORD_CLOCK:
      return &shadow[ic].clock;
    case GATE_WORD_PWM:
      return &shadow[ic].pwm;
    default:
      return &shadow[ic].channel[channel];
  }
}

static uint32_t address_of(unsigned ic, gate_word_t word, unsigned channel) {
  const bool macro = ic >= GATE_IC_MACRO;
  const uint32_t base = gate_ic_base(ic);
  switch (word) {
    case GATE_WORD_CLOCK:
      return base + (macro ? MACRO_IC_X_CLOCK_CONTROL : SERVO_IC_X_CLOCK_CONTROL);
    case GATE_WORD_PWM:
      return base + (macro ? MACRO_IC_X_PWM_CONTROL : SERVO_IC_X_PWM_CONTROL);
    case GATE_WORD_DAC_STROBE:
      return base + SERVO_IC_X_DAC_STROBE;
    case GATE_WORD_ADC_STROBE:
      return strobe_address(ic);
    case GATE_WORD_RING_CONTROL:
      return base + MACRO_IC_X_RING_CONTROL;
    case GATE_WORD_NODE_ACTIVATION:
      return base + MACRO_IC_Y_NODE_ACTIVATION;
    default:
      return base + (macro ? MACRO_IC_X_SUPPLEMENTARY_1 : SERVO_CHANNEL_X_CONTROL) + SERVO_CHANNEL_STRIDE * channel;
  }
}

/* The control words as their shadows: a start finds every amplifier off, also without a reset of the ICs. */
static void reset_channels(unsigned ic) {
  if (gate_ic_is_macrogate(ic)) return;
  const unsigned channels = ic >= GATE_IC_MACRO ? 2u : GATE_IC_CHANNELS;
  for (unsigned channel = 0; channel < channels; ++channel)
    *hal_x(address_of(ic, GATE_WORD_CHANNEL, channel)) = shadow[ic].channel[channel];
}

/* Of every place, found or not: a fault may come while ICs are looked for. The amplifiers go first. */
void gate_ic_outputs_off(void) {
  static const uint32_t outputs[] = {SERVO_CHANNEL_Y_OUT_A, SERVO_CHANNEL_Y_OUT_B, SERVO_CHANNEL_Y_OUT_C};
  for (unsigned ic = 0; ic < GATE_IC_COUNT; ++ic) reset_channels(ic);
  for (unsigned ic = 0; ic < GATE_IC_MACRO; ++ic)
    for (unsigned channel = 0; channel < GATE_IC_CHANNELS; ++channel) {
      *hal_x(address_of(ic, GATE_WORD_CHANNEL, channel)) =
          shadow[ic].channel[channel] | SERVO_CHANNEL_CONTROL_EQU_WRITE_MASK;
      for (unsigned i = 0; i < sizeof outputs / sizeof outputs[0]; ++i)
        *hal_y(gate_ic_base(ic) + SERVO_CHANNEL_STRIDE * channel + outputs[i]) = 0;
    }
}

/* A released clock pin is driven on until both clocks are high: one and a half phase periods at most
 * (docs/clock_select.md). */
static uint32_t release_began, release_us;

static uint32_t release_left(void) {
  const uint32_t passed = (hal_cycles() - release_began) / (hal_cycles_per_ms() / 1000u + 1u);
  return passed < release_us ? release_us - passed : 0u;
}

/* The clock word of `ic` is about to become `word`. */
static void note_release(unsigned ic, uint32_t word) {
  const uint32_t before = *hal_x(address_of(ic, GATE_WORD_CLOCK, 0));
  const uint32_t pwm = *hal_x(address_of(ic, GATE_WORD_PWM, 0));
  if ((word & ~before & inputs_of(ic)) == 0u) return;
  const uint32_t phase = (2u * FIELD_OF(pwm, SERVO_IC_PWM_CONTROL_MAX_COUNT) + 3u) *
                         (FIELD_OF(before, SERVO_IC_CLOCK_CONTROL_PHASE_DIVIDER) + 1u);
  const uint32_t left = release_left(), needed = (phase + phase / 2u) / 117u + 1u; /* 117.9648 ticks a microsecond */
  release_us = needed > left ? needed : left;
  release_began = hal_cycles();
}

void gate_ic_await_release(void) {
  hal_delay_us(release_left());
  release_us = 0;
}

void gate_ic_release_clocks(void) {
  for (uint32_t left = found; left != 0u; left &= left - 1u) {
    const unsigned ic = (unsigned)__builtin_ctz(left);
    const uint32_t address = address_of(ic, GATE_WORD_CLOCK, 0);
    const uint32_t word = *hal_x(address) & HAL_WORD_MASK, inputs = inputs_of(ic);
    if ((word & inputs) == inputs) continue;
    note_release(ic, word | inputs);
    *hal_x(address) = word | inputs;
  }
}

void gate_ic_find(void) {
  release_us = 0;
  found = macrogates = 0;
  for (unsigned ic = 0; ic < GATE_IC_COUNT; ++ic) {
    const struct gate_ic reset = {SERVO_IC_CLOCK_CONTROL_RESET, SERVO_IC_PWM_CONTROL_RESET, {0, 0, 0, 0}};
    shadow[ic] = reset;
    if (!answers(strobe_address(ic), HAL_WORD_MASK)) continue;
    found |= 1u << ic;
    /* Only a DSPGATE2 has supplementary channels. */
    if (ic >= GATE_IC_MACRO &&
        !answers(gate_ic_base(ic) + MACRO_IC_X_SUPPLEMENTARY_1, MACRO_IC_SUPPLEMENTARY_1_WRITTEN))
      macrogates |= 1u << ic;
    reset_channels(ic);
  }
}

static void set_field(unsigned ic, gate_word_t word, unsigned channel, unsigned lsb, unsigned width, uint32_t value) {
  if (!gate_ic_present(ic)) return;
  const uint32_t mask = ((1u << width) - 1u) << lsb;
  const uint32_t state = hal_mask_servo();
  uint32_t* kept = shadow_of(ic, word, channel);
  *kept = (*kept & ~mask) | ((value << lsb) & mask);
  const uint32_t address = address_of(ic, word, channel);
  if (word == GATE_WORD_CLOCK) note_release(ic, *kept);
  const uint32_t live = word == GATE_WORD_CHANNEL ? *hal_x(address) & CHANNEL_LIVE_BITS : 0u;
  *hal_x(address) = *kept | live;
  hal_unmask(state);
}

void gate_ic_set_field(unsigned ic, gate_word_t word, unsigned lsb, unsigned width, uint32_t value) {
  set_field(ic, word, 0, lsb, width, value);
}

void gate_ic_set_channel_field(unsigned ic, unsigned channel, unsigned lsb, unsigned width, uint32_t value) {
  set_field(ic, GATE_WORD_CHANNEL, channel, lsb, width, value);
}

/* The bit stands in no shadow, so no field write could take it back. */
void gate_ic_zero_counter(unsigned ic, unsigned channel) {
  if (!gate_ic_present(ic)) return;
  const uint32_t address = address_of(ic, GATE_WORD_CHANNEL, channel), state = hal_mask_servo();
  const uint32_t others =
      *hal_x(address) & ~(SERVO_CHANNEL_CONTROL_COUNTER_RESET_MASK | SERVO_CHANNEL_CONTROL_EQU_WRITE_MASK);
  *hal_x(address) = others | SERVO_CHANNEL_CONTROL_COUNTER_RESET_MASK;
  *hal_x(address) = others;
  hal_unmask(state);
}

void gate_ic_set_compare_output(unsigned ic, unsigned channel, bool high) {
  if (!gate_ic_present(ic)) return;
  volatile uint32_t* const control = hal_x(address_of(ic, GATE_WORD_CHANNEL, channel));
  const uint32_t state = hal_mask_servo();
  const uint32_t others = *control & ~SERVO_CHANNEL_CONTROL_EQU_STATE_MASK;
  *control = others | SERVO_CHANNEL_CONTROL_EQU_WRITE_MASK | (high ? SERVO_CHANNEL_CONTROL_EQU_STATE_MASK : 0u);
  hal_unmask(state);
}

void gate_ic_set_word(unsigned ic, gate_word_t word, uint32_t value) {
  if (!gate_ic_present(ic)) return;
  const uint32_t address = address_of(ic, word, 0);
  if (word == GATE_WORD_NODE_ACTIVATION)
    *hal_y(address) = value & HAL_WORD_MASK;
  else
    *hal_x(address) = value & HAL_WORD_MASK;
}
