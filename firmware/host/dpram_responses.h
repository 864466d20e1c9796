/* What goes to the host through the dual-ported RAM (host-bus:6.6): lines, each with its code, in a queue that holds
 * more than any one command answers, so that nothing ever waits for that host. One line at a time stands in the buffer
 * until the host has released it. Background task. */
#ifndef FIRMWARE_HOST_DPRAM_RESPONSES_H
#define FIRMWARE_HOST_DPRAM_RESPONSES_H

#include <stdbool.h>
#include <stdint.h>

void dpram_responses_initialize(void);
void dpram_responses_put(uint32_t code, uint8_t c); /* a character of the line being made */
void dpram_responses_end(uint32_t code);            /* ends it, or an answer: DPRAM_RESPONSE_... */
void dpram_responses_flush(void);                   /* what has not been shown is forgotten */
bool dpram_responses_are_read(void);                /* little waits: another command, another text may come */
bool dpram_responses_take_text(void); /* so they are, or the host has been given up and a text is dropped */

/* A pass: shows the next line when the last has been released. True: something waits or has been shown. */
bool dpram_responses_pass(void);
void dpram_responses_off(void); /* I58 = 0 */

#endif
