/* The two SSI inputs of a Geo PMAC (servo-ic:11.4), as I1015 to I1019 set them. Without Feedback Option 2 nothing is
 * written. */
#ifndef FIRMWARE_VARIABLES_SSI_INPUTS_H
#define FIRMWARE_VARIABLES_SSI_INPUTS_H

#include <stdbool.h>
#include <stdint.h>

/* Variable I(1015 + `which`) has this value. Background and real-time tasks, the other held off. */
void ssi_inputs_set(uint32_t which, uint32_t value);
bool ssi_inputs_have(uint32_t address); /* one of them sends it: behind a start it is 0 until it has */

#endif
