/* The flash store: what SAVE keeps. Background task. */
#ifndef FIRMWARE_IMAGE_SAVED_DATA_H
#define FIRMWARE_IMAGE_SAVED_DATA_H

#include <stdint.h>

typedef enum { SAVED_NONE, SAVED_GOOD, SAVED_DAMAGED } saved_t;
saved_t saved_data_restore_variables(uint32_t* initial_ics); /* I; and the ICs found at the last re-initialisation */
void saved_data_restore_user_memory(void);                   /* P, Q, M, axes, programs of the data just accepted */
void saved_data_write(uint32_t initial_ics);

#endif
