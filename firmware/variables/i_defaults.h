/* Factory defaults of I-variables that depend on what is fitted. */
#ifndef FIRMWARE_VARIABLES_I_DEFAULTS_H
#define FIRMWARE_VARIABLES_I_DEFAULTS_H

#include <stdbool.h>

#include "firmware/variables/i_table.h"

bool i_of_gate_ic(struct i_place place);
bool i_of_absent_ic(struct i_place place); /* reads 0 and ignores writes */
uint32_t i_default_clock_source(void);     /* I19: first IC found in the documented order; 0 when there is none */
uint32_t i_clock_direction(unsigned ic, uint32_t clock_source); /* 0 on the IC that I19 names, else inputs */
bool i_default_is_of_instance(uint32_t field);                  /* each motor, coordinate system or IC has its own */
double i_default_value(struct i_place place, const struct i_entry* entry, uint32_t clock_source);

#endif
