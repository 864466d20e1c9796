/* The interrupt tasks below the phase task (firmware:8.1). The servo task counts, runs timers, the watchdog counter and
 * the trajectories, and every I8+1 cycles requests the real-time task, which plans moves and strobes the hardware
 * watchdog. When real-time interrupts are meant to be rare (I8 up to 255, slow clocks), the servo task strobes between
 * them: the hardware allows 25 ms only. */
#include "firmware/hal/hal.h"
#include "firmware/kernel/internal.h"
#include "firmware/kernel/kernel.h"
#include "firmware/motion/motion.h"
#include "firmware/variables/variables.h"

#define SERVO_COUNTER 0x000000u
#define REAL_TIME_DURATIONS 0x00000Bu /* X: last, Y: longest real-time task */
#define WATCHDOG_COUNTER 0x000025u    /* Y: counter, X: lowest value since reset */
enum { WATCHDOG_DEFAULT = 4095, STROBE_GAP_MS = 10 };

static volatile uint32_t servo_count;  /* S */
static volatile int32_t watchdog;      /* S decrements, B reloads with S held off */
static int32_t watchdog_reload;        /* B, with S held off */
static int32_t watchdog_lowest;        /* S */
static uint32_t real_time_prescaler;   /* S */
static volatile bool real_time_active; /* R */
static uint32_t real_time_longest;     /* R, cycles */
static uint32_t strobe_gap;            /* cycles */
static volatile uint32_t strobed;      /* cycle count at the last strobe. S and R */

void tasks_initialize(void) {
  servo_count = 0;
  real_time_prescaler = 0;
  real_time_active = false;
  watchdog_lowest = WATCHDOG_DEFAULT;
  kernel_watchdog_reload();
  *hal_x(WATCHDOG_COUNTER) = (uint32_t)watchdog;
  watchdog_lowest = watchdog;
  real_time_longest = 0;
  strobe_gap = STROBE_GAP_MS * hal_cycles_per_ms();
  strobed = hal_cycles();
  phase_task_initialize();
}

uint32_t kernel_servo_count(void) { return servo_count; }

void kernel_watchdog_reload(void) {
  const int32_t reload = i_integer(40);
  const uint32_t state = hal_mask_servo();
  watchdog = watchdog_reload = reload == 0 ? WATCHDOG_DEFAULT : reload;
  *hal_y(WATCHDOG_COUNTER) = (uint32_t)watchdog;
  hal_unmask(state);
}

/* The background sleeps between real-time interrupts, which may be further apart than I40 cycles: it is woken in time
 * to reload. */
static void count_watchdog(void) {
  const int32_t left = watchdog - 1;
  if (left < -8388607) return;
  watchdog = left;
  if (left <= watchdog_reload / 2) kernel_wake_background();
  *hal_y(WATCHDOG_COUNTER) = (uint32_t)left & HAL_WORD_MASK;
  if (left >= watchdog_lowest) return;
  watchdog_lowest = left;
  *hal_x(WATCHDOG_COUNTER) = (uint32_t)left & HAL_WORD_MASK;
}

static void strobe(uint32_t now) {
  strobed = now;
  if (watchdog >= 0) hal_watchdog_strobe();
}

void kernel_servo_interrupt(void) {
  const uint32_t began = hal_cycles();
  const uint32_t count = servo_count + 1u;
  servo_count = count;
  *hal_x(SERVO_COUNTER) = count & HAL_WORD_MASK;
  count_watchdog();
  motion_servo_update();
  if (++real_time_prescaler > (uint32_t)i_integer(8)) {
    real_time_prescaler = 0;
    if (real_time_active) kernel_status_set(STATUS_REAL_TIME_REENTRY | STATUS_REAL_TIME_WARNING);
    hal_request_real_time();
  } else if (began - strobed > strobe_gap && !real_time_active && !hal_real_time_pending()) {
    strobe(began); /* the real-time task has done its duty, the next is not due yet */
  }
  *hal_y(TASK_DURATIONS) = ((hal_cycles() - began) / 2u) & HAL_WORD_MASK;
  if (hal_servo_pending()) kernel_status_set(STATUS_SERVO_ERROR);
}

void kernel_real_time_interrupt(void) {
  const uint32_t began = hal_cycles();
  real_time_active = true;
  motion_real_time_update();
  strobe(began);
  kernel_wake_background();
  const uint32_t took = hal_cycles() - began; /* with the tasks that interrupted it */
  *hal_x(REAL_TIME_DURATIONS) = (took / 2u) & HAL_WORD_MASK;
  if (took > real_time_longest) {
    real_time_longest = took;
    *hal_y(REAL_TIME_DURATIONS) = (took / 2u) & HAL_WORD_MASK;
  }
  real_time_active = false;
}
