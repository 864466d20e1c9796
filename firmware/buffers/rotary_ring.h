/* The rings of program words behind the rotary buffers, one a coordinate system, in user memory. Words are stored by
 * the background task, with I45 = 1 by the real-time task, and taken by the real-time task; what both change is changed
 * with the real-time task held off. Nobody else stores while the buffers are open for binary entry. */
#ifndef FIRMWARE_BUFFERS_ROTARY_RING_H
#define FIRMWARE_BUFFERS_ROTARY_RING_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/dimensions.h"

struct rotary {
  uint32_t base, size;    /* words; size 0: not defined. Background */
  uint32_t write;         /* next word to store. Who stores: the background, or the real-time task for binary buffers */
  uint32_t read;          /* next word to calculate. Real-time task, background while it is masked */
  volatile uint32_t used; /* words stored and not calculated. Both, under the mask */
  volatile uint32_t lines; /* lines stored and not calculated: PR. Both, under the mask */
  bool requested;          /* opened since it was defined: BREQ takes part (host-bus:5.7, state other than IDLE) */
  volatile bool full;      /* Rotary Buffer Full. Both, under the mask */
  uint32_t generation;     /* changes when it is emptied or text is stored: words not published are void. Background */
};

extern struct rotary rotary_buffers[COORDINATE_SYSTEMS];

#endif
