/* The handshake of the reports in the dual-ported RAM (host-bus:6.4): the host sets its busy bit and then looks whether
 * a set is ready; the controller takes the ready bit back and then looks whether the host is busy. So at least one of
 * them sees the other, and no set changes under a host that has found it ready. */
#ifndef FIRMWARE_HOST_DPRAM_REPORT_H
#define FIRMWARE_HOST_DPRAM_REPORT_H

#include <stdbool.h>
#include <stdint.h>

struct dpram_report {
  const uint32_t busy, timer; /* offsets; the ready word is behind the timer's */
  uint32_t ready;             /* that word, of the last whole set */
  uint32_t began;             /* servo count at which the last one did */
  bool is_on, writes;         /* a set is under way */
};

void dpram_report_initialize(struct dpram_report* report); /* a start: what the RAM holds is left */
void dpram_report_off(struct dpram_report* report);        /* nothing is ready any more */
/* True when a set is to be begun or is under way. `period`: servo cycles from one to the next; 0: none. */
bool dpram_report_is_due(struct dpram_report* report, int32_t period);
void dpram_report_end(struct dpram_report* report); /* the set is whole */

/* What is 24 bits wide, sign-extended, and both halves of a 48-bit word, low half first. */
void dpram_put_word(uint32_t offset, uint32_t word);
void dpram_put_long(uint32_t offset, uint32_t x, uint32_t y);

#endif
