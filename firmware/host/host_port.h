/* Characters to and from the host port: two queues in RAM, filled and emptied by the host port interrupt. */
#ifndef FIRMWARE_HOST_HOST_PORT_H
#define FIRMWARE_HOST_HOST_PORT_H

/* image/trap.S reads this file too. Characters: with so many a queue is full, and so many fit into it. */
#define HOST_PORT_LIMIT_BITS 11
#define HOST_PORT_RECEIVE_LIMIT (1 << HOST_PORT_LIMIT_BITS)
#define HOST_PORT_RECEIVE_BITS (HOST_PORT_LIMIT_BITS + 2)
#define HOST_PORT_RECEIVE_SIZE (1 << HOST_PORT_RECEIVE_BITS)
#define HOST_PORT_PACE 8 /* characters in a phase period, both ways together, while a motor is enabled */

#ifndef __ASSEMBLER__
#include <stdbool.h>
#include <stdint.h>

/* The receive queue. The interrupt owns the first count, the background the second; both run freely and are reduced
 * when used. */
extern uint8_t host_port_received[HOST_PORT_RECEIVE_SIZE];
extern volatile uint32_t host_port_received_count, host_port_taken_count;

/* Characters that are taken without another look: as many as the queue has room for. While a motor is enabled each
 * phase interrupt takes that back and renews the right to HOST_PORT_PACE; when they have been taken or sent the port is
 * held, its interrupts off, until the next one puts host_port_enables into HCR. Interrupts. */
extern volatile int32_t host_port_granted;
extern volatile uint32_t host_port_renewed, host_port_held, host_port_enables;

void host_port_initialize(void);
void host_port_interrupt(void);         /* image/trap.S, where it has more to do than a character of a line */
void host_port_character(uint8_t c);    /* a character from the host: interrupt, or a test */
void host_port_reserve(void);           /* servo task: a full queue takes what the port holds */
bool host_port_next_output(uint8_t* c); /* the next character for the host: interrupt, or a test */

/* Background: next character received. *flushed: ^X came since the last call, what was taken before is void. */
bool host_port_take(uint8_t* c, bool* flushed);
/* The same for all that lie one behind the other, control characters too; they stay where they are until they are let
 * go. Returns their number. */
uint32_t host_port_text(const uint8_t** text, bool* flushed);
void host_port_text_taken(uint32_t count);
uint32_t host_port_room(void);    /* characters that host_port_send takes without waiting */
uint32_t host_port_flushes(void); /* ^X so far: what waits to be sent is void */
bool host_port_waiting(void);     /* characters received and not taken */
void host_port_send(uint8_t c);   /* background: waits for room; gives up after half a second without a reader */
/* Control characters that may not wait, bit = code. Real-time task: the second clears them. */
extern volatile uint32_t host_port_urgent_codes;
uint32_t host_port_urgent(void);
void host_port_open_output(void); /* a new reply: output is sent again after a flush or a host that did not read */
/* What follows is sent by a program, which gives up sooner when the host has sent something; and no longer. */
void host_port_program_sends(bool sends);
extern void (*const host_port_meanwhile)(void); /* what the background does while a reply waits (image/tables.c) */

#endif
#endif
