/* I-, P- and Q-variables. Safe from every task except phase and servo. */
#ifndef FIRMWARE_VARIABLES_VARIABLES_H
#define FIRMWARE_VARIABLES_VARIABLES_H

#include <stdbool.h>
#include <stdint.h>

double i_variable_read(uint32_t number);                /* 0..8191 */
void i_variable_write(uint32_t number, double value);   /* reduces to the range, honours I41, writes the hardware field behind it */
double p_variable_read(uint32_t number);
void p_variable_write(uint32_t number, double value);
double q_variable_read(uint32_t cs, uint32_t number);   /* split of the pool by I68 */
void q_variable_write(uint32_t cs, uint32_t number, double value);
int32_t i_integer(uint32_t number);                     /* fast read of an integer I-variable, any task */

#endif
