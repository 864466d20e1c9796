/* Host port queues. The interrupt owns the head of the receive queue and the tail of the transmit queue, the background
 * the other two; both indices of a queue run freely and are reduced when used. A full receive queue leaves the
 * character in the port, so that the host sees its transmit register occupied and waits. It would wait with a control
 * character too: so the servo task takes some all the same, into a reserve. */
#include "firmware/host/host_port.h"

#include "firmware/hal/hal.h"
#include "firmware/kernel/background.h"
#include "firmware/kernel/slice.h"
#include "firmware/kernel/watchdog.h"
#include "firmware/motion/motor.h"
#include "firmware/variables/i_variables.h"
#include "rtl/regs/brick_regs.h"

enum { TRANSMIT_SIZE = 4096, CONTROL_X = 0x18, ROOM_TIMEOUT_MS = 500, PROGRAM_TIMEOUT_MS = 20 };
enum { RESERVED_AT_ONCE = 2 }; /* what the port holds: the next is the host's newest */

/* ^A ^D ^K ^O ^Q stop things: they act in the real-time task, which is asked for at once, whatever the background is
 * at, and again in their own place. */
#define URGENT ((1u << 0x01) | (1u << 0x04) | (1u << 0x0B) | (1u << 0x0F) | (1u << 0x11))

uint8_t host_port_received[HOST_PORT_RECEIVE_SIZE];
volatile uint32_t host_port_received_count, host_port_taken_count;
volatile int32_t host_port_granted;
volatile uint32_t host_port_renewed, host_port_held, host_port_enables;

static uint8_t transmit[TRANSMIT_SIZE];
static volatile uint32_t transmit_head, transmit_tail;
static volatile uint32_t flushed, discard;
volatile uint32_t host_port_urgent_codes;
static volatile uint32_t flushes;             /* ^X so far */
static volatile uint32_t flushed_to;          /* host_port_received_count at the last ^X: what came before is void */
static volatile bool receiving, transmitting; /* as in HCR */
static volatile uint32_t reserved;            /* characters that a full queue still takes. Servo task, interrupt */
static bool of_program;                       /* what is being sent */
static uint32_t spare; /* of a phase period with a queue that is nearly full: looked at one by one. Interrupt */

/* Where transmit_tail stood when a host that did not read was given up: it is not waited for again until it reads. */
static uint32_t given_up_at;
static bool given_up;

static void enable(bool receive_on, bool transmit_on) {
  receiving = receive_on;
  transmitting = transmit_on;
  host_port_enables = (receive_on ? HI08_HCR_HRIE_MASK : 0u) | (transmit_on ? HI08_HCR_HTIE_MASK : 0u);
  if (host_port_held == 0u) hal_host_interrupts(receive_on, transmit_on);
}

static uint32_t waiting(void) { return host_port_received_count - host_port_taken_count; }

/* What was granted has been used. A host that never pauses takes no phase or servo interrupt away (motion:1.6): while a
 * motor is enabled the others wait in the port for the next phase interrupt. False: they do. */
static bool renew(void) {
  const int32_t room = HOST_PORT_RECEIVE_LIMIT - (int32_t)waiting();
  if (motors_enabled == 0u) {
    host_port_granted = room;
    return true;
  }
  if (spare == 0u && host_port_renewed == 0u) {
    host_port_held = 1;
    hal_host_interrupts(false, false);
    return false;
  }
  if (host_port_renewed != 0u) { /* what was left of the period before goes with it */
    host_port_renewed = 0;
    host_port_granted = room >= HOST_PORT_PACE ? HOST_PORT_PACE : 0;
    spare = room >= HOST_PORT_PACE ? 0u : HOST_PORT_PACE;
  }
  if (spare != 0u) --spare;
  return true;
}

/* Nobody grants any more: the last motor has been killed, or there is no phase clock. */
static void release(void) {
  host_port_held = 0;
  hal_host_interrupts(receiving, transmitting);
}

void host_port_initialize(void) {
  host_port_granted = 0;
  host_port_held = host_port_renewed = spare = 0;
  host_port_received_count = host_port_taken_count = transmit_head = transmit_tail = 0;
  host_port_urgent_codes = flushed = flushed_to = flushes = discard = reserved = 0;
  given_up = of_program = false;
  enable(true, false);
}

void host_port_character(uint8_t c) {
  if (c == CONTROL_X) {
    flushed_to = host_port_received_count;
    transmit_head = transmit_tail;
    flushed = discard = 1;
    ++flushes;
    if (i_integer(I63_CONTROL_X_ECHO) != 0) {
      transmit[transmit_head % TRANSMIT_SIZE] = c;
      ++transmit_head;
      if (!transmitting) enable(receiving, true);
    }
    background_wake();
    return;
  }
  host_port_received[host_port_received_count % HOST_PORT_RECEIVE_SIZE] = c;
  ++host_port_received_count;
  slice_hurry = 1;
  if (c >= ' ') return;
  if (((URGENT >> c) & 1u) != 0u) {
    host_port_urgent_codes |= 1u << c;
    hal_request_real_time();
  }
  background_wake();
}

bool host_port_next_output(uint8_t* c) {
  if (transmit_tail == transmit_head) return false;
  *c = transmit[transmit_tail % TRANSMIT_SIZE];
  ++transmit_tail;
  return true;
}

/* A character. Where there is one more the interrupt comes again. */
void host_port_interrupt(void) {
  if (host_port_granted <= 0 && !renew()) return;
  const uint32_t status = *hal_x(HI08_X_HSR);
  if ((status & HI08_HSR_HRDF_MASK) != 0u && receiving) {
    const bool full = waiting() >= HOST_PORT_RECEIVE_LIMIT;
    if (!full || reserved != 0u) {
      --host_port_granted;
      host_port_character((uint8_t)*hal_x(HI08_X_HORX));
    }
    if (full && (reserved == 0u || --reserved == 0u)) enable(false, transmitting);
  } else if ((status & HI08_HSR_HTDE_MASK) != 0u && transmitting) {
    uint8_t c;
    --host_port_granted;
    if (host_port_next_output(&c)) *hal_x(HI08_X_HOTX) = c;
    if (transmit_tail == transmit_head) enable(receiving, false);
  }
}

void host_port_reserve(void) {
  if (receiving && host_port_held == 0u) return;
  const uint32_t state = hal_mask_all();
  if (host_port_held != 0u && motors_enabled == 0u) release();
  if (!receiving && waiting() + RESERVED_AT_ONCE <= HOST_PORT_RECEIVE_SIZE) {
    reserved = RESERVED_AT_ONCE;
    enable(true, transmitting);
  }
  hal_unmask(state);
}

uint32_t host_port_room(void) { return TRANSMIT_SIZE - (transmit_head - transmit_tail); }
uint32_t host_port_flushes(void) { return flushes; }
bool host_port_waiting(void) { return waiting() != 0u; }

/* A ^X came, or the queue was full. True: what was taken before is void. `end`: what may be taken now. */
static __attribute__((noinline)) bool take_up(uint32_t* end) {
  const uint32_t state = hal_mask_all();
  const bool flush = flushed != 0u;
  *end = host_port_received_count;
  if (flush) host_port_taken_count = flushed_to;
  flushed = 0;
  if (!receiving && waiting() < HOST_PORT_RECEIVE_LIMIT / 2u) enable(true, transmitting);
  hal_unmask(state);
  return flush;
}

/* Runs between the carriage return of a line and BREQ, like the next: nothing is masked in the usual case. */
bool host_port_take(uint8_t* c, bool* void_before) {
  uint32_t end = host_port_received_count; /* before the look at ^X: what comes behind one is not taken before it */
  *void_before = flushed != 0u || !receiving ? take_up(&end) : false;
  const uint32_t tail = host_port_taken_count;
  if (tail == end) return false;
  *c = host_port_received[tail % HOST_PORT_RECEIVE_SIZE];
  host_port_taken_count = tail + 1u;
  return true;
}

uint32_t host_port_text(const uint8_t** text, bool* void_before) {
  uint32_t end = host_port_received_count; /* as above */
  *void_before = flushed != 0u || !receiving ? take_up(&end) : false;
  const uint32_t first = host_port_taken_count % HOST_PORT_RECEIVE_SIZE;
  const uint32_t stored = end - host_port_taken_count, room = HOST_PORT_RECEIVE_SIZE - first;
  *text = host_port_received + first;
  return stored < room ? stored : room;
}

void host_port_text_taken(uint32_t count) {
  host_port_taken_count += count;
  if (receiving || waiting() >= HOST_PORT_RECEIVE_LIMIT / 2u) return;
  const uint32_t state = hal_mask_all(); /* the queue was full; nobody may come to look at it again */
  if (!receiving) enable(true, transmitting);
  hal_unmask(state);
}

/* False when the host has not read for too long. */
static bool wait_for_room(void) {
  const uint32_t start = hal_cycles();
  const uint32_t tail = transmit_tail;
  while (transmit_head - transmit_tail >= TRANSMIT_SIZE) {
    const uint32_t limit = of_program && host_port_waiting() ? PROGRAM_TIMEOUT_MS : ROOM_TIMEOUT_MS;
    if (transmit_tail == tail && hal_cycles() - start > limit * hal_cycles_per_ms()) return false;
    host_port_meanwhile();
    hal_idle(&background_work);
  }
  return true;
}

void host_port_send(uint8_t c) {
  if (discard != 0u) return;
  if (transmit_head - transmit_tail >= TRANSMIT_SIZE && !wait_for_room()) {
    discard = 1;
    if (of_program) return; /* the host's own reply is waited for */
    given_up = true;
    given_up_at = transmit_tail;
    return;
  }
  const uint32_t state = hal_mask_all();
  if (discard == 0u) {
    transmit[transmit_head % TRANSMIT_SIZE] = c;
    ++transmit_head;
    if (!transmitting) enable(receiving, true);
  }
  hal_unmask(state);
}

void host_port_program_sends(bool sends) { of_program = sends; }

void host_port_open_output(void) {
  if (given_up && transmit_tail == given_up_at && host_port_room() == 0u) return;
  given_up = false;
  discard = 0;
}

uint32_t host_port_urgent(void) {
  const uint32_t state = hal_mask_all();
  const uint32_t codes = host_port_urgent_codes;
  host_port_urgent_codes = 0;
  hal_unmask(state);
  return codes;
}
