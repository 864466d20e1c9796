/* Host port queues. The interrupt owns the head of the receive queue and the tail of the transmit queue, the background
 * the other two; both indices of a queue run freely and are reduced when used. A full receive queue leaves the
 * character in the port, so that the host sees its transmit register occupied and waits. */
#include "firmware/host/host_port.h"

#include "firmware/hal/hal.h"
#include "firmware/kernel/background.h"
#include "firmware/kernel/watchdog.h"
#include "firmware/variables/i_variables.h"
#include "rtl/regs/brick_regs.h"

enum { RECEIVE_SIZE = 2048, TRANSMIT_SIZE = 4096, CONTROL_X = 0x18, ROOM_TIMEOUT_MS = 500 };

/* ^A ^D ^K ^O ^Q stop things: they act in the real-time task, which is asked for at once, whatever the background is
 * at, and again in their own place. */
#define URGENT ((1u << 0x01) | (1u << 0x04) | (1u << 0x0B) | (1u << 0x0F) | (1u << 0x11))

static uint8_t receive[RECEIVE_SIZE], transmit[TRANSMIT_SIZE];
static volatile uint32_t receive_head, receive_tail, transmit_head, transmit_tail;
static volatile uint32_t urgent, flushed, discard;
static volatile uint32_t flushed_to;          /* receive_head at the last ^X: what came before is void */
static volatile bool receiving, transmitting; /* as in HCR */

static void enable(bool receive_on, bool transmit_on) {
  receiving = receive_on;
  transmitting = transmit_on;
  hal_host_interrupts(receive_on, transmit_on);
}

void host_port_initialize(void) {
  receive_head = receive_tail = transmit_head = transmit_tail = 0;
  urgent = flushed = flushed_to = discard = 0;
  enable(true, false);
}

void host_port_character(uint8_t c) {
  if (c == CONTROL_X) {
    flushed_to = receive_head;
    transmit_head = transmit_tail;
    flushed = discard = 1;
    if (i_integer(I63_CONTROL_X_ECHO) != 0) {
      transmit[transmit_head % TRANSMIT_SIZE] = c;
      ++transmit_head;
      if (!transmitting) enable(receiving, true);
    }
    background_wake();
    return;
  }
  receive[receive_head % RECEIVE_SIZE] = c;
  ++receive_head;
  if (c >= ' ') return;
  if (((URGENT >> c) & 1u) != 0u) {
    urgent |= 1u << c;
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

void host_port_interrupt(void) {
  const uint32_t status = *hal_x(HI08_X_HSR);
  if ((status & HI08_HSR_HRDF_MASK) != 0u && receiving) {
    if (receive_head - receive_tail < RECEIVE_SIZE) {
      host_port_character((uint8_t)*hal_x(HI08_X_HORX));
    } else {
      enable(false, transmitting);
    }
  }
  if ((status & HI08_HSR_HTDE_MASK) != 0u && transmitting) {
    uint8_t c;
    if (host_port_next_output(&c)) *hal_x(HI08_X_HOTX) = c;
    if (transmit_tail == transmit_head) enable(receiving, false);
  }
}

bool host_port_waiting(void) { return receive_tail != receive_head; }

/* A ^X came, or the queue was full. True: what was taken before is void. */
static __attribute__((noinline)) bool take_up(void) {
  const uint32_t state = hal_mask_all();
  const bool flush = flushed != 0u;
  if (flush) receive_tail = flushed_to;
  flushed = 0;
  if (!receiving && receive_head - receive_tail < RECEIVE_SIZE / 2u) enable(true, transmitting);
  hal_unmask(state);
  return flush;
}

/* Runs between the carriage return of a line and BREQ, like the next: nothing is masked in the usual case. */
bool host_port_take(uint8_t* c, bool* void_before) {
  *void_before = flushed != 0u || !receiving ? take_up() : false;
  const uint32_t tail = receive_tail;
  if (tail == receive_head) return false;
  *c = receive[tail % RECEIVE_SIZE];
  receive_tail = tail + 1u;
  return true;
}

uint32_t host_port_take_text(uint8_t* text, uint32_t most, bool* void_before) {
  *void_before = flushed != 0u || !receiving ? take_up() : false;
  const uint32_t head = receive_head;
  uint32_t tail = receive_tail, count = 0;
  for (; count < most && tail != head; ++tail) {
    const uint8_t c = receive[tail % RECEIVE_SIZE];
    if (c < ' ') break;
    text[count++] = c;
  }
  receive_tail = tail;
  return count;
}

/* False when the host has not read for ROOM_TIMEOUT_MS. */
static bool wait_for_room(void) {
  static const uint32_t never = 0;
  const uint32_t start = hal_cycles();
  const uint32_t limit = ROOM_TIMEOUT_MS * hal_cycles_per_ms();
  const uint32_t tail = transmit_tail;
  while (transmit_head - transmit_tail >= TRANSMIT_SIZE) {
    if (transmit_tail == tail && hal_cycles() - start > limit) return false;
    watchdog_reload();
    hal_idle(&never);
  }
  return true;
}

void host_port_send(uint8_t c) {
  if (discard != 0u) return;
  if (transmit_head - transmit_tail >= TRANSMIT_SIZE && !wait_for_room()) {
    discard = 1;
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

void host_port_open_output(void) { discard = 0; }

uint32_t host_port_urgent(void) {
  if (urgent == 0u) return 0;
  const uint32_t state = hal_mask_all();
  const uint32_t codes = urgent;
  urgent = 0;
  hal_unmask(state);
  return codes;
}
