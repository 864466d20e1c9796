#include "firmware/command/session.h"

#include <stdatomic.h>

struct session session;

static struct session host;             /* the host's, while a program has its turn */
static volatile enum session_port port; /* whose turn it is */
static enum session_port buffer_owner;
bool session_owns_open_buffer;

static void turn_to(enum session_port next) {
  port = next;
  session_owns_open_buffer = buffer_owner == next;
}

void session_initialize(void) {
  session = (struct session){0, 0, 0};
  buffer_owner = SESSION_HOST;
  turn_to(SESSION_HOST);
}

/* Higher tasks look at the host's coordinate system: there is one for them at any instant. */
void session_begin_program(uint32_t cs, uint32_t motor) {
  host = session;
  atomic_signal_fence(memory_order_release);
  turn_to(SESSION_PROGRAM);
  atomic_signal_fence(memory_order_release);
  session = (struct session){cs, motor, 0};
}

void session_end_program(void) {
  if (port == SESSION_HOST) return;
  session = host;
  atomic_signal_fence(memory_order_release);
  turn_to(SESSION_HOST);
}

bool session_is_program(void) { return port == SESSION_PROGRAM; }
uint32_t session_host_cs(void) { return port == SESSION_PROGRAM ? host.cs : session.cs; }

void session_own_buffer(void) {
  buffer_owner = port;
  session_owns_open_buffer = true;
}
