/* BREQ. The pin of the selected coordinate system is high when the system's rotary buffer was opened and is not full:
 *   line stored      low for T_PULSE; then Full = 1 and low if PR >= I17, else high unless Full was 1 already
 *   line calculated  Full = 0 and high if PR < I16
 *   opened           Full = 1 and low if PR >= I17
 *   I16, I17 changed as for a calculated line if Full is 1, as for an opened buffer if it is 0
 * While a fixed buffer is open, the pin is its own: a line takes it low for T_PULSE, then Full = 1 and low if no more
 * than I18 words are open, else Full = 0 and high.
 * The whole pulse runs with all tasks held off: it lasts 2 us, and nothing that motors take can stretch or cut it. */
#include "firmware/buffers/buffer_request.h"

#include "firmware/base/dimensions.h"
#include "firmware/buffers/regions.h"
#include "firmware/buffers/rotary_ring.h"
#include "firmware/hal/hal.h"
#include "firmware/variables/i_variables.h"

static struct {
  bool high;        /* level of the pin. All tasks, under the mask */
  uint32_t changed; /* cycle count at its last change */
  int32_t on, off;  /* I16 and I17 at the last look. All tasks, under the mask */
  int32_t fixed;    /* I18. As those */
  uint32_t host;    /* coordinate system that the host selects. As those */
  uint32_t panel;   /* and the panel. As those */
  bool fixed_open;  /* Background, under the mask */
  bool fixed_full;  /* of the open fixed buffer. As the limits */
} request;

static void drive(bool high) {
  if (high == request.high) return;
  request.high = high;
  if (high)
    hal_host_signals(HAL_SIGNAL_BREQ, 0);
  else
    hal_host_signals(0, HAL_SIGNAL_BREQ);
  request.changed = hal_cycles();
}

static bool is_ready(uint32_t cs) {
  if (cs >= COORDINATE_SYSTEMS) return false;
  const struct rotary* ring = &rotary_buffers[cs];
  return ring->size != 0 && ring->requested && !ring->full;
}

uint32_t buffer_request_selected(void) { return request.panel == PANEL_IS_OFF ? request.host : request.panel; }

static bool is_wanted(void) { return request.fixed_open ? !request.fixed_full : is_ready(buffer_request_selected()); }

/* `open`: region_open_words, which looks at every region, before tasks are held off. */
static void decide_fixed(uint32_t open) { request.fixed_full = (int32_t)open <= request.fixed; }

static void keep_high_time(void) {
  if (request.high) hal_await_us(request.changed, BREQ_HIGH_US);
}

void buffer_request_initialize(void) {
  request.high = request.fixed_open = false;
  hal_host_signals(0, HAL_SIGNAL_BREQ);
  request.on = i_integer(I16_ROTARY_REQUEST_ON);
  request.off = i_integer(I17_ROTARY_REQUEST_OFF);
  request.fixed = i_integer(I18_FIXED_BUFFER_WARNING);
  request.host = 0;
  request.panel = PANEL_IS_OFF;
}

static bool is_shown(uint32_t cs) { return !request.fixed_open && cs == buffer_request_selected(); }

void buffer_request_begin_line(uint32_t cs) {
  if (!is_shown(cs)) return;
  keep_high_time();
  drive(false);
}

void buffer_request_line_stored(uint32_t cs) {
  struct rotary* ring = &rotary_buffers[cs];
  if ((int32_t)ring->lines >= i_integer(I17_ROTARY_REQUEST_OFF)) ring->full = true;
  if (!is_shown(cs) || !is_ready(cs)) return;
  hal_await_us(request.changed, BREQ_PULSE_US);
  drive(true);
}

void buffer_request_line_calculated(uint32_t cs) {
  struct rotary* ring = &rotary_buffers[cs];
  if (!ring->full || (int32_t)ring->lines >= i_integer(I16_ROTARY_REQUEST_ON)) return;
  ring->full = false;
  if (is_shown(cs)) drive(is_ready(cs));
}

static void show(void) { drive(is_wanted()); }

void buffer_request_opened(uint32_t cs) {
  struct rotary* ring = &rotary_buffers[cs];
  uint32_t state = hal_mask_real_time();
  ring->requested = true;
  if ((int32_t)ring->lines >= i_integer(I17_ROTARY_REQUEST_OFF)) ring->full = true;
  show();
  hal_unmask(state);
}

void buffer_request_emptied(uint32_t cs) {
  rotary_buffers[cs].full = false;
  show();
}

static void fixed_shown(bool open) {
  const uint32_t words = region_open_words();
  uint32_t state = hal_mask_real_time();
  request.fixed_open = open;
  decide_fixed(words);
  show();
  hal_unmask(state);
}

void buffer_request_fixed_opened(void) { fixed_shown(true); }
void buffer_request_fixed_changed(void) { fixed_shown(true); }
void buffer_request_fixed_closed(void) { fixed_shown(false); }

void buffer_request_fixed_line_stored(void) {
  const uint32_t words = region_open_words();
  uint32_t state = hal_mask_all();
  keep_high_time();
  drive(false);
  decide_fixed(words);
  if (!request.fixed_full) {
    hal_await_us(request.changed, BREQ_PULSE_US);
    drive(true);
  }
  hal_unmask(state);
}

bool buffer_request_fixed_full(void) { return !request.fixed_open || request.fixed_full; }

static void limits_changed(struct rotary* ring) {
  int32_t lines = (int32_t)ring->lines;
  if (ring->full)
    ring->full = lines >= request.on;
  else
    ring->full = lines >= request.off;
}

void buffer_request_evaluate(void) {
  /* Counting takes longer than the pin may follow a selection: only for whom it is. */
  const uint32_t words = request.fixed_open ? region_open_words() : 0;
  uint32_t state = hal_mask_real_time();
  int32_t on = i_integer(I16_ROTARY_REQUEST_ON), off = i_integer(I17_ROTARY_REQUEST_OFF);
  bool changed = on != request.on || off != request.off;
  request.on = on;
  request.off = off;
  request.fixed = i_integer(I18_FIXED_BUFFER_WARNING);
  decide_fixed(words);
  for (uint32_t cs = 0; changed && cs < COORDINATE_SYSTEMS; cs++)
    if (rotary_buffers[cs].requested) limits_changed(&rotary_buffers[cs]);
  show();
  hal_unmask(state);
}

/* No more than that. Limits that have changed too are found by the poll. */
static void select(uint32_t* by, uint32_t cs) {
  if (*by == cs) return;
  const uint32_t state = hal_mask_real_time();
  *by = cs;
  show();
  hal_unmask(state);
}

void buffer_request_host_selects(uint32_t cs) { select(&request.host, cs); }
void buffer_request_panel_selects(uint32_t cs) { select(&request.panel, cs); }

void buffer_request_poll(void) {
  if (request.on != i_integer(I16_ROTARY_REQUEST_ON) || request.off != i_integer(I17_ROTARY_REQUEST_OFF) ||
      request.fixed != i_integer(I18_FIXED_BUFFER_WARNING))
    buffer_request_evaluate();
}
