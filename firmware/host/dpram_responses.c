/* A record of the queue is two bytes of code, one of length, and the text. A line that has not ended yet stands behind
 * the head. A reply that does not fit is cut, and its end is an error: that takes a line of many reports of all
 * variables. */
#include "firmware/host/dpram_responses.h"

#include "firmware/base/dpram.h"
#include "firmware/base/error.h"
#include "firmware/hal/gate_ic.h"
#include "firmware/hal/hal.h"
#include "firmware/variables/i_variables.h"

enum { QUEUE_BYTES = 1 << 18, HEADER = 3, LINE_CHARACTERS = DPRAM_RESPONSE_BYTES - 1, FEW_BYTES = 2048 };
enum { RELEASE_TIMEOUT_MS = 500 };

static uint8_t queue[QUEUE_BYTES] __attribute__((section(".noinit"))); /* no start clears it: that takes 3 ms */
static uint32_t head, tail;                                            /* run freely */
static uint32_t length;                                                /* of the line behind the head */
static bool cut;
static bool line_is_high;  /* of the interrupt */
static uint32_t shown_at;  /* cycle counter */
static bool shown;         /* a line stands in the buffer */
static bool host_given_up; /* it has not released it for too long */

void dpram_responses_initialize(void) {
  dpram_responses_flush();
  line_is_high = shown = host_given_up = false;
}

void dpram_responses_flush(void) {
  head = tail = length = 0;
  cut = false;
}

static void store(uint32_t at, uint32_t byte) { queue[at % QUEUE_BYTES] = (uint8_t)byte; }
static uint32_t stored(uint32_t at) { return queue[at % QUEUE_BYTES]; }

/* With `more` characters, and room for the end of the answer behind it. */
static bool fits(uint32_t more) { return head - tail + HEADER + length + more + HEADER <= QUEUE_BYTES; }

static bool is_program_s(uint32_t code) { return code == DPRAM_RESPONSE_SEND || code == DPRAM_RESPONSE_COMMAND; }

static bool is_dropped(uint32_t code) { return host_given_up && is_program_s(code) && !dpram_responses_are_read(); }

static void close_line(uint32_t code) {
  store(head, code);
  store(head + 1u, code >> 8);
  store(head + 2u, length);
  head += HEADER + length;
  length = 0;
}

void dpram_responses_put(uint32_t code, uint8_t c) {
  if (is_dropped(code)) return;
  if (length == LINE_CHARACTERS) close_line(code);
  if (!fits(1)) cut = true;
  if (cut) return;
  store(head + HEADER + length, c);
  ++length;
}

void dpram_responses_end(uint32_t code) {
  if (is_dropped(code)) return;
  const bool is_line = code == DPRAM_RESPONSE_LINE || is_program_s(code);
  if (is_line && (cut || !fits(0))) {
    cut = true;
    length = 0;
    return;
  }
  close_line(cut && !is_line ? DPRAM_RESPONSE_ERROR | ERR_NO_ROOM : code);
  cut = false;
}

bool dpram_responses_are_read(void) { return head - tail < FEW_BYTES; }
bool dpram_responses_take_text(void) { return dpram_responses_are_read() || host_given_up; }

/* The line of I56: EQU1 of servo IC 0, or CTRL0 on an Ultralite and a UMAC, which cannot have that IC. */
static void set_line(bool high) {
  if (line_is_high == high) return;
  line_is_high = high;
  if ((hal_strap(HAL_STRAP_PRODUCT) & (HAL_PRODUCT_ULTRALITE | HAL_PRODUCT_UMAC)) == 0u) {
    gate_ic_set_compare_output(0, 0, high);
    return;
  }
  volatile uint32_t* const outputs = hal_x(BOARD_LATCHES_X_CONTROL_OUTPUTS);
  const uint32_t state = hal_mask_real_time();
  const uint32_t others = *outputs & ~BOARD_LATCHES_CONTROL_OUTPUTS_CTRL0_MASK;
  *outputs = others | (high ? BOARD_LATCHES_CONTROL_OUTPUTS_CTRL0_MASK : 0u);
  hal_unmask(state);
}

static void show(void) {
  const uint32_t code = stored(tail) | stored(tail + 1u) << 8, count = stored(tail + 2u);
  tail += HEADER;
  for (uint32_t i = 0; i <= count; i += 2u) {
    const uint32_t low = i < count ? stored(tail + i) : 0u, high = i + 1u < count ? stored(tail + i + 1u) : 0u;
    dpram_write(DPRAM_RESPONSE_TEXT + i, low | high << 8);
  }
  tail += count;
  dpram_write(DPRAM_RESPONSE_COUNT, count + 1u);
  dpram_write(DPRAM_RESPONSE_CONTROL, code);
  shown = true;
  shown_at = hal_cycles();
  set_line(i_integer(I56_DPRAM_INTERRUPT) != 0);
}

bool dpram_responses_pass(void) {
  if (!shown && head == tail) return false;
  if (dpram_read(DPRAM_RESPONSE_CONTROL) != 0u) {
    if (hal_cycles() - shown_at > RELEASE_TIMEOUT_MS * hal_cycles_per_ms()) host_given_up = true;
    return !host_given_up;
  }
  shown = host_given_up = false;
  set_line(false);
  if (head == tail) return false;
  show();
  return true;
}

void dpram_responses_off(void) {
  set_line(false);
  dpram_responses_initialize();
}
