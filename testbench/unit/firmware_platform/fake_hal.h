/* Controls of the fake hardware behind firmware/hal/hal.h: two arrays of PMAC words, strap words, and the host's side
 * of the character queues. Plain C, so that the firmware is compiled exactly as for the target. */
#ifndef TESTBENCH_UNIT_FIRMWARE_PLATFORM_FAKE_HAL_H
#define TESTBENCH_UNIT_FIRMWARE_PLATFORM_FAKE_HAL_H

/* NOLINTBEGIN(modernize-*): C, also where C++ includes it */
#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

void fake_hal_power_on(uint32_t fitted); /* memory cleared, ICs as BoardInputs::fitted, flash erased */
void fake_hal_set_strap(unsigned word, uint32_t value);
uint32_t fake_hal_signals(void);    /* bits HAL_SIGNAL_* now on the latch */
unsigned fake_hal_breq_falls(void); /* falling edges of BREQ since power-on */
void fake_hal_set_cycles(uint32_t cycles);
void fake_hal_pass(uint32_t cycles);     /* time passes */
void fake_hal_set_look(uint32_t cycles); /* time that a look at the cycle counter takes; 100 after power-on */
bool fake_hal_masked(void);              /* some task is held off */
uint32_t fake_hal_longest_mask(void);    /* longest time that one was, in cycles, since the last call */
void fake_hal_real_time_taken(void);
unsigned fake_hal_strobes(void);                /* of the hardware watchdog since power-on */
void fake_hal_fit(uint32_t fitted);             /* changes the ICs without power-on */
void fake_hal_stop_clocks(bool stopped);        /* no phase interrupt comes */
const char* fake_host_output(uint32_t* length); /* everything sent to the host since the last call; valid until then */

/* While the firmware waits: a millisecond passes and `action` is called, in place of the host that reads. Null: it
 * reads again. */
void fake_hal_on_wait(void (*action)(void));

/* What others do where work in slices is left (firmware/kernel/slice.h); then the work goes on. Null: nothing. */
void fake_hal_on_pause(void (*action)(void));

/* Edges of BREQ in order, newest last. */
struct fake_edge {
  bool high;
  uint32_t cycles;
};
unsigned fake_hal_breq_edges(const struct fake_edge** list); /* count */
void fake_hal_clear_breq_edges(void);

/* Writes to device words (gate ICs, latches) in order, newest last. */
struct fake_write {
  bool x;
  uint32_t address, value;
  uint32_t cycles; /* hal_cycles() then */
};
unsigned fake_hal_writes(const struct fake_write** log); /* count; only words whose value changed are listed */
void fake_hal_clear_writes(void);

#ifdef __cplusplus
}
#endif
/* NOLINTEND(modernize-*) */

#endif
