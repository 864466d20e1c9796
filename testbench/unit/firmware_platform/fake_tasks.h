/* Tasks of the firmware on the fake hardware: who runs, who is held off, the stack of work in slices, and the host at
 * the other end of the character queues. Tests call tasks one after the other; fake_interrupts.h lets them come
 * anywhere. */
#ifndef TESTBENCH_UNIT_FIRMWARE_PLATFORM_FAKE_TASKS_H
#define TESTBENCH_UNIT_FIRMWARE_PLATFORM_FAKE_TASKS_H

/* NOLINTBEGIN(modernize-*): C, also where C++ includes it */
#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* In the order in which they interrupt each other (docs/firmware.md, Tasks). */
enum fake_task { FAKE_BACKGROUND, FAKE_REAL_TIME, FAKE_SERVO, FAKE_PHASE, FAKE_HOST };

void fake_tasks_power_on(void);
bool fake_task_take(enum fake_task task); /* runs it now as an interrupt would; false, and nothing, if it is held off */
void fake_task_run_servo(void);           /* a test's servo interrupt, which cannot be held off */
void fake_task_run_real_time(void);       /* the same of the real-time task; what asked for it is forgotten */
void fake_tasks_servo_waits(bool waits);  /* whenever a servo task ends, the next is due already */
void fake_tasks_ignore_masks(bool ignored); /* hal_mask_... hold nobody off: whoever relies on them must fail */

/* Called whenever the background holds nobody off any more, in place of an interrupt that has waited. Null: nothing. */
void fake_hal_on_unmask(void (*action)(void));

bool fake_hal_masked(void);           /* some task is held off */
uint32_t fake_hal_longest_mask(void); /* longest time that one was, in cycles, since the last call */

/* Work in slices (firmware/kernel/slice.h). Where it can be left, `action` shows what others do, then it goes on; with
 * `leaves` it is left in earnest, until the next real-time task. Null: nothing. */
void fake_hal_on_pause(void (*action)(void));
void fake_hal_slices_leave(bool leave);
bool fake_hal_slice_is_left(void); /* in the middle of its work */

/* The host. Characters that it sends come with the host port's interrupts, those that the firmware sends are read. */
void fake_host_input(uint8_t c);
bool fake_host_input_waits(void);
const char* fake_host_output(uint32_t* length); /* everything sent to the host since the last call; valid until then */

/* While the firmware waits: a millisecond passes and `action` is called, in place of the host that reads. Null: it
 * reads again. */
void fake_hal_on_wait(void (*action)(void));

#ifdef __cplusplus
}
#endif
/* NOLINTEND(modernize-*) */

#endif
