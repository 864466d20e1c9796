/* The ASCII port in the dual-ported RAM (host-bus:6.6): command lines and control characters of a host that has its own
 * addresses and its own answers. On while I58 = 1, there is such RAM and I24 names it. Background task. */
#ifndef FIRMWARE_HOST_DPRAM_ASCII_H
#define FIRMWARE_HOST_DPRAM_ASCII_H

#include <stdbool.h>

void dpram_ascii_initialize(void);
bool dpram_ascii_is_on(void);
void dpram_ascii_pass(void); /* shows an answer, takes a control character and executes a line */

/* The line that is executed, from `at` on, before letters were made capital. What is not of it is itself. */
const char* dpram_ascii_as_typed(const char* at);

#endif
