/* P- and Q-variables. Safe from every task except phase and servo. */
#ifndef FIRMWARE_VARIABLES_PQ_VARIABLES_H
#define FIRMWARE_VARIABLES_PQ_VARIABLES_H

#include <stdint.h>

#include "firmware/base/dimensions.h"

double p_variable_read(uint32_t number);
void p_variable_write(uint32_t number, double value);
double q_variable_read(uint32_t cs, uint32_t number); /* split of the pool by I68 */
void q_variable_write(uint32_t cs, uint32_t number, double value);

#endif
