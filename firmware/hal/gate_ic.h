/* Servo ICs and MACRO ICs: which are fitted, where they are, and their global and channel-control words.
 * Index of an IC: 0..9 servo IC 0..9, 10..17 servo IC 2*..9*, 18..21 MACRO IC 0..3. */
#ifndef FIRMWARE_HAL_GATE_IC_H
#define FIRMWARE_HAL_GATE_IC_H

#include <stdbool.h>
#include <stdint.h>

#include "rtl/regs/brick_regs.h" /* GATE_IC_COUNT */

enum { GATE_IC_STARRED = 10, GATE_IC_MACRO = 18, GATE_IC_CHANNELS = 4 };

void gate_ic_find(void); /* probes every possible place by write and read-back of a strobe word */
bool gate_ic_present(unsigned ic);
uint32_t gate_ic_found(void);           /* bit per IC */
bool gate_ic_is_macrogate(unsigned ic); /* a MACRO IC of the kind that makes no servo clock */
uint32_t gate_ic_macrogates(void);      /* bit per IC */
uint32_t gate_ic_configuration(void);   /* bit per IC, bits 24..27 MACRO IC 0..3 is a MACROGATE */
uint32_t gate_ic_base(unsigned ic);
uint32_t gate_ic_direction_variable(unsigned ic); /* 7007 ... 7957, 6807 ... 6957 */
unsigned gate_ic_of_direction(uint32_t variable); /* the reverse; GATE_IC_COUNT when it is none */

/* Clock direction that makes both clocks inputs, as I7m07 has it: 3, on a MACROGATE 1, because it has the bit for PHASE
 * only. */
uint32_t gate_ic_direction_inputs(unsigned ic);

/* Words of an IC. The firmware keeps what it wrote: read-modify-write reads from the IC only the bits of a channel's
 * control word that others switch at run time. */
typedef enum {
  GATE_WORD_CLOCK,
  GATE_WORD_PWM,
  GATE_WORD_DAC_STROBE, /* servo IC only */
  GATE_WORD_ADC_STROBE,
  GATE_WORD_RING_CONTROL, /* MACRO IC only */
  GATE_WORD_NODE_ACTIVATION,
  GATE_WORD_CHANNEL
} gate_word_t;
void gate_ic_set_field(unsigned ic, gate_word_t word, unsigned lsb, unsigned width, uint32_t value);
void gate_ic_set_channel_field(unsigned ic, unsigned channel, unsigned lsb, unsigned width,
                               uint32_t value); /* channel 0..3; 0..1 of a MACRO IC */
/* The encoder counter of a channel of a servo IC counts from 0. */
void gate_ic_zero_counter(unsigned ic, unsigned channel);
/* EQU of a channel of a servo IC, as if its compare registers had been met. */
void gate_ic_set_compare_output(unsigned ic, unsigned channel, bool high);
/* A start without a reset of the ICs finds the clocks running: their source lets go before its variables are written.
 */
void gate_ic_release_clocks(void);

/* Waits until no IC drives a clock pin any more whose direction has been made an input. */
void gate_ic_await_release(void);
/* Amplifier enables, EQU and commands of all channels; nothing else runs any more. */
void gate_ic_outputs_off(void);
void gate_ic_set_word(unsigned ic, gate_word_t word, uint32_t value);

#endif
