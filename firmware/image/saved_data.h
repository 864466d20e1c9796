/* What SAVE keeps and the start-up takes back. Background task. */
#ifndef FIRMWARE_IMAGE_SAVED_DATA_H
#define FIRMWARE_IMAGE_SAVED_DATA_H

#include <stdbool.h>
#include <stdint.h>

void saved_data_write(uint32_t initial_ics);

/* In steps, because the I-variables that the clocks need come before them, and they before all that takes long. */
typedef enum { SAVED_NONE, SAVED_GOOD, SAVED_DAMAGED } saved_t;
saved_t saved_data_restore_early(uint32_t* initial_ics); /* early I; and the ICs found at the last re-initialisation */
bool saved_data_rest_is_whole(void);                     /* of what SAVED_GOOD was said of */
void saved_data_restore_rest(void);                      /* other I, P, Q, M, axes, programs, the password */

#endif
