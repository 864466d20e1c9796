/* What a host has addressed: `&n`, `#n`, `##n`. Modal. Background task; `cs` is read by any task. */
#ifndef FIRMWARE_COMMAND_SESSION_H
#define FIRMWARE_COMMAND_SESSION_H

#include <stdint.h>

struct session {
  uint32_t cs;          /* coordinate system, 0..15 */
  uint32_t motor;       /* 0..31 */
  uint32_t motor_group; /* 0..3, the eight motors of ^B ^F ^P ^V */
};
extern struct session session;

void session_initialize(void); /* &1 #1 ##0 */

#endif
