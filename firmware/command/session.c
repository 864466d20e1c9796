#include "firmware/command/session.h"

#include "firmware/variables/dpram_use.h"

struct session session;

static struct session host, dpram; /* their addresses while it is another's turn */
static enum session_port port;     /* whose turn it is */
static enum session_port buffer_owner;
bool session_owns_open_buffer;

static void turn_to(enum session_port next) {
  port = next;
  session_owns_open_buffer = buffer_owner == next;
}

void session_initialize(void) {
  session = host = dpram = (struct session){0, 0, 0};
  buffer_owner = SESSION_HOST;
  turn_to(SESSION_HOST);
}

static void begin(enum session_port next, struct session addresses) {
  host = session;
  session = addresses;
  turn_to(next);
}

void session_begin_dpram(void) { begin(SESSION_DPRAM, dpram); }

void session_begin_program(uint32_t cs, uint32_t motor) { begin(SESSION_PROGRAM, (struct session){cs, motor, 0}); }

void session_end(void) {
  if (port == SESSION_HOST) return;
  if (port == SESSION_DPRAM) dpram = session;
  session = host;
  turn_to(SESSION_HOST);
}

bool session_is_program(void) { return port == SESSION_PROGRAM; }

bool session_may_close_buffer(void) {
  const bool owner_is_off = buffer_owner == SESSION_DPRAM && !(i_integer(I58_DPRAM_ASCII) != 0 && dpram_is_used());
  return session_owns_open_buffer || owner_is_off;
}

void session_own_buffer(void) {
  buffer_owner = port;
  session_owns_open_buffer = true;
}
