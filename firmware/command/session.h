/* Who gives the command being executed and what they have addressed: `&n`, `#n`, `##n`. The host's addresses are modal;
 * a command that a program gives (COMMAND"..") brings its own and leaves none behind, as from a port of its own.
 * Background task. */
#ifndef FIRMWARE_COMMAND_SESSION_H
#define FIRMWARE_COMMAND_SESSION_H

#include <stdbool.h>
#include <stdint.h>

enum session_port { SESSION_HOST, SESSION_PROGRAM };

struct session {
  uint32_t cs;          /* coordinate system, 0..15 */
  uint32_t motor;       /* 0..31 */
  uint32_t motor_group; /* 0..3, the eight motors of ^B ^F ^P ^V */
};
extern struct session session;

void session_initialize(void);                           /* the host's turn: &1 #1 ##0; nobody has opened a buffer */
void session_begin_program(uint32_t cs, uint32_t motor); /* a program's turn, until ... */
void session_end_program(void);                          /* ... this, or a restart that its command has asked for */
bool session_is_program(void);
uint32_t session_host_cs(void); /* coordinate system that the host addresses, whoever's turn it is. Any task */

/* The open buffer takes lines from the port that has opened it, and from no other (firmware:4.1). */
void session_own_buffer(void);
extern bool session_owns_open_buffer; /* whose turn it is: read for each statement, in the time to BREQ */
static inline bool session_owns_buffer(void) { return session_owns_open_buffer; }

#endif
