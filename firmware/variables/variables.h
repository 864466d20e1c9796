/* I-, P-, Q- and M-variables. Safe from every task except phase and servo. Table: variables/i_variables.def. */
#ifndef FIRMWARE_VARIABLES_VARIABLES_H
#define FIRMWARE_VARIABLES_VARIABLES_H

#include <stdbool.h>
#include <stdint.h>

#define VARIABLE_COUNT 8192u

double i_variable_read(uint32_t number); /* 0..8191 */
void i_variable_write(uint32_t number,
                      double value);        /* reduces to the range, honours I41, writes the hardware field behind it */
double i_variable_default(uint32_t number); /* what `I{number}=*` assigns */
double p_variable_read(uint32_t number);
void p_variable_write(uint32_t number, double value);
double q_variable_read(uint32_t cs, uint32_t number); /* split of the pool by I68 */
void q_variable_write(uint32_t cs, uint32_t number, double value);
uint32_t q_variable_count(void); /* Q-variables of each coordinate system */
double m_variable_read(uint32_t number);
void m_variable_write(uint32_t number, double value);
int32_t i_integer(uint32_t number); /* fast read of an integer I-variable, any task */

/* Clock directions (I7m07, I7m57, I6807...) written since the last call go to the ICs: inputs first, then the output.
 */
void i_variable_apply_clock_directions(void);

/* Start-up: all I-variables to their defaults; I19, I20..I23 and I4900.. from the ICs found. Hardware is not written.
 */
void i_variable_initialize(void);
void i_variable_write_hardware(void); /* every servo and MACRO IC register from its I-variables */

/* SAVE and restore. A restore begins with zeros, read-only values and the defaults of ICs that were not there when it
 * was saved. */
struct i_saved {
  double value;
  int32_t integer;
};
bool i_variable_save(uint32_t number, struct i_saved* saved); /* false: nothing to keep, zero or not saved at all */
void i_variable_begin_restore(uint32_t saved_ics);            /* bit per IC of hal/gate_ic.h */
void i_variable_restore(uint32_t number, const struct i_saved* saved);

/* How a value is reported under I9 bit 1. */
typedef enum { I_FORMAT_DECIMAL, I_FORMAT_HEX } i_format_t;
i_format_t i_variable_format(uint32_t number);

/* 48-bit floating-point words (X = high mantissa, Y = low mantissa and exponent), as the user sees them with RL. */
struct float48 {
  uint32_t x, y;
};
struct float48 float48_pack(double value);
double float48_unpack(struct float48 word);

#endif
