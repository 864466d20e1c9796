/* One host, so one session. */
#include "firmware/command/session.h"

struct session session;

void session_initialize(void) { session = (struct session){0, 0, 0}; }
