/* Who gives the command being executed and what they have addressed: `&n`, `#n`, `##n`. The addresses of each port, the
 * host port and the dual-ported RAM, are modal; a command that a program gives (COMMAND"..") brings its own and leaves
 * none behind, as from a port of its own. Background task. */
#ifndef FIRMWARE_COMMAND_SESSION_H
#define FIRMWARE_COMMAND_SESSION_H

#include <stdbool.h>
#include <stdint.h>

enum session_port { SESSION_HOST, SESSION_DPRAM, SESSION_PROGRAM };

struct session {
  uint32_t cs;          /* coordinate system, 0..15 */
  uint32_t motor;       /* 0..31 */
  uint32_t motor_group; /* 0..3, the eight motors of ^B ^F ^P ^V */
};
extern struct session session;

void session_initialize(void);  /* the host port's turn: &1 #1 ##0 of each port; nobody has opened a buffer */
void session_begin_dpram(void); /* another's turn, until ... */
void session_begin_program(uint32_t cs, uint32_t motor);
void session_end(void); /* ... this, or a restart that its command has asked for: the host port's again */
bool session_is_program(void);

/* The open buffer takes lines from the port that has opened it, and from no other (firmware:4.1). */
void session_own_buffer(void);
extern bool session_owns_open_buffer; /* whose turn it is: read for each statement, in the time to BREQ */
static inline bool session_owns_buffer(void) { return session_owns_open_buffer; }
bool session_may_close_buffer(void); /* it does, or the port that has opened it is off */

#endif
