/* The hardware and kernel settings behind I-variables: registers of ICs by the `field` of the table, period of the
 * real-time task, reload of the watchdog. */
#ifndef FIRMWARE_VARIABLES_I_HARDWARE_H
#define FIRMWARE_VARIABLES_I_HARDWARE_H

#include <stdint.h>

#include "firmware/variables/i_table.h"

void i_hardware_initialize(void);
void i_hardware_write(struct i_place place, const struct i_entry* entry, uint32_t value);

/* Clock directions (I7m07, I7m57, I6807...) written since the last call go to the ICs: inputs first, then the output.
 */
void i_hardware_apply_clock_directions(void);

#endif
