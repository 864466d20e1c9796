/* BREQ. The pin of the selected coordinate system is high when the system's rotary buffer was opened and is not full:
 *   line stored      low for T_PULSE; then Full = 1 and low if PR >= I17, else high unless Full was 1 already
 *   line calculated  Full = 0 and high if PR < I16
 *   opened           Full = 1 and low if PR >= I17
 *   I16, I17 changed as for a calculated line if Full is 1, as for an opened buffer if it is 0
 * The whole pulse runs with the real-time task held off: it lasts 2 us, and no calculation can stretch or cut it. */
#include "firmware/buffers/buffer_request.h"

#include "firmware/base/dimensions.h"
#include "firmware/buffers/rotary_ring.h"
#include "firmware/hal/hal.h"
#include "firmware/variables/i_variables.h"

static struct {
  bool high;         /* level of the pin. All tasks, under the mask */
  uint32_t changed;  /* cycle count at its last change */
  int32_t on, off;   /* I16 and I17 at the last look. All tasks, under the mask */
  uint32_t selected; /* coordinate system shown at the last look. As those */
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

void buffer_request_initialize(void) {
  request.high = false;
  hal_host_signals(0, HAL_SIGNAL_BREQ);
  request.changed = hal_cycles();
  request.on = i_integer(I16_ROTARY_REQUEST_ON);
  request.off = i_integer(I17_ROTARY_REQUEST_OFF);
  request.selected = buffer_request_selected();
}

void buffer_request_begin_line(uint32_t cs) {
  if (cs != buffer_request_selected()) return;
  if (request.high) hal_await_us(request.changed, BREQ_HIGH_US);
  drive(false);
}

void buffer_request_line_stored(uint32_t cs) {
  struct rotary* ring = &rotary_buffers[cs];
  if ((int32_t)ring->lines >= i_integer(I17_ROTARY_REQUEST_OFF)) ring->full = true;
  if (cs != buffer_request_selected() || !is_ready(cs)) return;
  hal_await_us(request.changed, BREQ_PULSE_US);
  drive(true);
}

void buffer_request_line_calculated(uint32_t cs) {
  struct rotary* ring = &rotary_buffers[cs];
  if (!ring->full || (int32_t)ring->lines >= i_integer(I16_ROTARY_REQUEST_ON)) return;
  ring->full = false;
  if (cs == buffer_request_selected()) drive(is_ready(cs));
}

static void show(void) { drive(is_ready(buffer_request_selected())); }

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

static void limits_changed(struct rotary* ring) {
  int32_t lines = (int32_t)ring->lines;
  if (ring->full)
    ring->full = lines >= request.on;
  else
    ring->full = lines >= request.off;
}

void buffer_request_evaluate(void) {
  uint32_t state = hal_mask_real_time();
  int32_t on = i_integer(I16_ROTARY_REQUEST_ON), off = i_integer(I17_ROTARY_REQUEST_OFF);
  bool changed = on != request.on || off != request.off;
  request.on = on;
  request.off = off;
  request.selected = buffer_request_selected();
  for (uint32_t cs = 0; changed && cs < COORDINATE_SYSTEMS; cs++)
    if (rotary_buffers[cs].requested) limits_changed(&rotary_buffers[cs]);
  show();
  hal_unmask(state);
}

void buffer_request_poll(void) {
  if (request.selected != buffer_request_selected() || request.on != i_integer(I16_ROTARY_REQUEST_ON) ||
      request.off != i_integer(I17_ROTARY_REQUEST_OFF))
    buffer_request_evaluate();
}
