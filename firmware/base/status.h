/* The first global status word (firmware:5.7): bits that any task may set and that stay until the next start. */
#ifndef FIRMWARE_BASE_STATUS_H
#define FIRMWARE_BASE_STATUS_H

#include <stdbool.h>
#include <stdint.h>

enum {
  STATUS_REAL_TIME_REENTRY = 1 << 22,
  STATUS_SERVO_ERROR = 1 << 20,
  STATUS_GATHERING = 1 << 19, /* follows */
  STATUS_WATCHDOG = 1 << 15,
  STATUS_COMPENSATION = 1 << 14, /* follows I51 */
  STATUS_FLASH_ERROR = 1 << 10,
  STATUS_REAL_TIME_WARNING = 1 << 9,
  STATUS_CONFIGURATION = 1 << 7,
  STATUS_NO_PHASE_CLOCK = 1 << 3 /* follows the clocks */
};

void status_initialize(void);
void status_set(uint32_t bits);
void status_clear(uint32_t bits);         /* those that stay until the next start or until a user writes them 0 */
void status_show(uint32_t bits, bool on); /* a bit that follows what it tells */
uint32_t status_word(void);
bool status_motors_may_enable(void); /* false while the phase clock is missing or the IC set differs */

#endif
