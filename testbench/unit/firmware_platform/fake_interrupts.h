/* Interrupts anywhere: the compiler announces each access of the native firmware to memory, and there an interrupt of
 * any task may come that is not held off. So it meets whatever it would meet between two instructions of the target. An
 * access of eight bytes (double, 64-bit integer, program word) is two on the target: an interrupt may come between its
 * halves. Work in slices is left in earnest. By seed; off unless begun. */
#ifndef TESTBENCH_UNIT_FIRMWARE_PLATFORM_FAKE_INTERRUPTS_H
#define TESTBENCH_UNIT_FIRMWARE_PLATFORM_FAKE_INTERRUPTS_H

/* NOLINTBEGIN(modernize-*): C, also where C++ includes it */
#include <stdbool.h>
#include <stdint.h>

#include "testbench/unit/firmware_platform/fake_tasks.h"

#ifdef __cplusplus
extern "C" {
#endif

/* From now on: an interrupt every `gap` accesses, on average. */
void fake_interrupts_begin(uint32_t seed, uint32_t gap);
void fake_interrupts_end(void);
void fake_interrupts_soon(void); /* a real-time interrupt within some accesses */
bool fake_interrupts_are_on(void);
/* Servo interrupts come some twenty times as often as on the target, where a real-time task has ended long before it is
 * due again. For a test that asks whether one was late: until the next begin, a servo interrupt is held off that would
 * make it due before it has ended. */
void fake_interrupts_leave_time(void);
bool fake_interrupts_time_is_left(void);

struct fake_interrupt_counts {
  unsigned taken[FAKE_HOST + 1]; /* by task */
  unsigned held_off, torn;       /* that came while masked; that came between the halves of an access */
};
struct fake_interrupt_counts fake_interrupts_counts(void); /* since they were begun */

/* Called in each interrupt, before its task: a test looks at what the interrupted code has written so far. */
void fake_interrupts_on_take(void (*action)(enum fake_task task));

void fake_interrupts_taken(enum fake_task task); /* fake hardware: an interrupt begins */
void fake_interrupts_mend(void); /* fake hardware: the halves of the latest access come together here at the latest */

#ifdef __cplusplus
}
#endif
/* NOLINTEND(modernize-*) */

#endif
