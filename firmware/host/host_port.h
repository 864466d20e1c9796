/* Characters to and from the host port: two queues in RAM, filled and emptied by the host port interrupt. */
#ifndef FIRMWARE_HOST_HOST_PORT_H
#define FIRMWARE_HOST_HOST_PORT_H

#include <stdbool.h>
#include <stdint.h>

void host_port_initialize(void);
void host_port_interrupt(void);         /* image/trap.S: one character each way */
void host_port_character(uint8_t c);    /* a character from the host: interrupt, or a test */
bool host_port_next_output(uint8_t* c); /* the next character for the host: interrupt, or a test */

/* Background: next character received. *flushed: ^X came since the last call, what was taken before is void. */
bool host_port_take(uint8_t* c, bool* flushed);
/* The same for a run of characters that are no control characters; returns their number, which ends at one of those. */
uint32_t host_port_take_text(uint8_t* text, uint32_t most, bool* flushed);
bool host_port_waiting(void);     /* characters received and not taken */
void host_port_send(uint8_t c);   /* background: waits for room; gives up after half a second without a reader */
void host_port_open_output(void); /* a new reply: output is sent again after a flush or a host that did not read */
uint32_t host_port_urgent(void);  /* real-time task: control characters that may not wait, bit = code; cleared */

#endif
