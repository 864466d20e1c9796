/* Tasks, clocks and start-up of the controller (docs/firmware.md). */
#ifndef FIRMWARE_KERNEL_KERNEL_H
#define FIRMWARE_KERNEL_KERNEL_H

#include <stdbool.h>
#include <stdint.h>

/* Start-up */
typedef enum { KERNEL_START_SAVED, KERNEL_START_DEFAULTS } kernel_start_t;
void kernel_start(kernel_start_t mode); /* power-up, $$$ and $$$***: background only */
void kernel_save(void);                 /* SAVE: I, P, Q and M definitions to flash */

/* Background */
void kernel_background_pass(void); /* housekeeping and one command line */
void kernel_wake_background(void); /* there is something to do: any task */

/* Status */
uint32_t kernel_status_word(void);   /* first global status word: bits of firmware:5.7 */
bool kernel_motors_may_enable(void); /* false while the phase clock is missing or the IC set differs */

/* Clocks and time */
uint32_t kernel_servo_count(void);  /* servo interrupts since start, 32 bits */
uint32_t kernel_phase_period(void); /* nominal, CPU cycles */
void kernel_clock_changed(void);    /* a divider or direction was written: the clocks are watched closely for a while */
void kernel_watchdog_reload(void);  /* Y:$25 from I40 */

/* Phase task: Ixx00, Ixx01 or Ixx83 of motor 1..32 was written. Background and real-time tasks. */
void kernel_phase_motor_changed(uint32_t motor);

/* Interrupt handlers, called by image/trap.S. */
void kernel_phase_interrupt(void);
void kernel_servo_interrupt(void);
void kernel_real_time_interrupt(void);

enum {
  STATUS_REAL_TIME_REENTRY = 1 << 22,
  STATUS_SERVO_ERROR = 1 << 20,
  STATUS_WATCHDOG = 1 << 15,
  STATUS_FLASH_ERROR = 1 << 10,
  STATUS_REAL_TIME_WARNING = 1 << 9,
  STATUS_CONFIGURATION = 1 << 7,
  STATUS_NO_PHASE_CLOCK = 1 << 3
};

#endif
