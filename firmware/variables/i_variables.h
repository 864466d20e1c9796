/* I-variables: values, saving, effects. Safe from every task except phase and servo, which may use i_integer. Table:
 * variables/i_variables.def. */
#ifndef FIRMWARE_VARIABLES_I_VARIABLES_H
#define FIRMWARE_VARIABLES_I_VARIABLES_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/dimensions.h"
#include "firmware/variables/i_names.h"

double i_variable_read(uint32_t number); /* 0..8191 */
void i_variable_write(uint32_t number,
                      double value); /* within the range of the table, honours I41, writes what stands behind it */
/* Bits of `mask` of an integer variable that stands behind no hardware; the others are read in one piece with it. */
void i_variable_write_part(uint32_t number, uint32_t mask, uint32_t bits);
void i_timer_write(uint32_t number, int32_t value); /* Isx11, Isx12 as words of memory: 24 bits, whatever I41 says */
void i_timers_pass(void); /* background: one that has run down stays so when the servo count has come round, 22 days */
double i_variable_default(uint32_t number);            /* what `I{number}=*` assigns */
void i_variable_set_open_memory_end(uint32_t address); /* I4908, which nobody else writes */
uint32_t i_variable_locks(void);                       /* bits 4 to 11 of I4904, a process lock each */
void i_variable_set_locks(uint32_t locks);             /* under the mask */
bool i_variable_foreground_in_position(void);          /* I13, but of a Geo PMAC, where that is something else */
extern int32_t i_integers[];
void i_variable_set_lookahead_state(uint32_t cs, uint32_t state); /* Isx21, as it is: no order */
int32_t i_integer_of(uint32_t number);                            /* i_integer of a number that is not known before */
/* Fast read of an integer, any task; of a real it would have the whole part only. Below the variables of coordinate
 * systems no timer stands: a constant number there is one load. */
static inline int32_t i_integer(uint32_t number) {
  return __builtin_constant_p(number) && number < I_CS_FIRST ? i_integers[number] : i_integer_of(number);
}

/* What a write of an I-variable does in higher layers, by enum i_field of the table; image/tables.c fills it in. Called
 * after the value is stored, without it where the entry is null. `instance`: motor, coordinate system or IC. */
typedef void (*i_effect_t)(uint32_t instance);
extern const i_effect_t i_effects[];

/* Start-up: all I-variables to their defaults; I19, I20..I23 and I4900.. from the ICs found. Hardware is not written.
 */
void i_variable_initialize(void);
void i_variable_write_hardware(void); /* ICs and kernel from their I-variables */
void i_variable_write_ssi(void);      /* SSI inputs of a Geo PMAC, when all that was saved is there */

/* SAVE and restore. A restore begins with zeros, read-only values and the defaults of ICs that were not there when it
 * was saved. What the store holds is checked: a value that the variable cannot have is left out or reduced. */
typedef enum { I_NOT_KEPT, I_KEPT_INTEGER, I_KEPT_FLOAT } i_kept_t;
bool i_variable_is_early(uint32_t number);         /* the clocks or the bus need it: globals and those of ICs */
i_kept_t i_variable_kept(uint32_t number);         /* NOT: zero, a state or read-only */
void i_variable_begin_restore(uint32_t saved_ics); /* bit per IC of hal/gate_ic.h */
void i_variable_restore_integer(uint32_t number, int32_t value);
void i_variable_restore_float(uint32_t number, double value);

/* How a value is reported under I9 bit 1. */
typedef enum { I_FORMAT_DECIMAL, I_FORMAT_HEX } i_format_t;
i_format_t i_variable_format(uint32_t number);

#endif
