/* BREQ, the buffer request pin, and the Rotary Buffer Full bits (firmware:4.5, host-bus:5.7). State is kept for all 16
 * coordinate systems; the pin shows the selected one. This file is the only writer of the pin. */
#ifndef FIRMWARE_BUFFERS_BUFFER_REQUEST_H
#define FIRMWARE_BUFFERS_BUFFER_REQUEST_H

#include <stdbool.h>
#include <stdint.h>

enum {
  BREQ_PULSE_US = 2, /* T_PULSE: low time of a line that does not fill the buffer; at least 1 us */
  BREQ_HIGH_US = 1   /* least high time between two pulses, so that the interrupt controller sees each edge */
};

void buffer_request_initialize(void); /* before anybody selects: &1, without a panel */
/* Who selects the coordinate system that drives the pin says so when it changes: the host by `&n`, and a control panel,
 * which goes before it while it is active. The pin follows within 10 us. */
enum { PANEL_IS_OFF = 0xFF };
void buffer_request_host_selects(uint32_t cs);  /* background */
uint32_t buffer_request_selected(void);         /* by panel or host; none: COORDINATE_SYSTEMS or above. Any task */
void buffer_request_panel_selects(uint32_t cs); /* COORDINATE_SYSTEMS: none. Background, real-time task */
void buffer_request_begin_line(uint32_t cs); /* background, real-time task masked: pin low before the line is counted */
void buffer_request_line_stored(uint32_t cs);     /* same section, line counted: Full decided, pulse timed, pin final */
void buffer_request_line_calculated(uint32_t cs); /* real-time task, line no longer counted */
void buffer_request_opened(uint32_t cs);          /* OPEN ROTARY, OPEN BINARY ROTARY */
void buffer_request_emptied(uint32_t cs);         /* CLEAR, DELETE, DEFINE: Full = 0 */
/* An open fixed buffer owns the pin, whatever rotary buffers do meanwhile (firmware:4.6). Background. */
void buffer_request_fixed_opened(void);
void buffer_request_fixed_changed(void);     /* CLEAR: other open memory */
void buffer_request_fixed_line_stored(void); /* pin low, then Full decided by I18, and high again unless full */
void buffer_request_fixed_closed(void);
bool buffer_request_fixed_full(void); /* Fixed Buffer Full; 1 while none is open */
void buffer_request_evaluate(void);   /* I16, I17, I18 or open memory changed: pin shows what it has to */
void buffer_request_poll(void);       /* real-time task, first: notices changes of I16 to I18 */

#endif
