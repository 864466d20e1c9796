/* Controls of the fake hardware behind firmware/hal/hal.h: two arrays of PMAC words, strap words, time. Tasks and the
 * host's side of the character queues: fake_tasks.h. Plain C, so that the firmware is compiled exactly as for the
 * target. */
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
enum { FAKE_IMAGE_WORDS = 1000 };        /* that CHECKSUM adds up: 1, 2, 3, ... in their low 24 bits */
unsigned fake_hal_image_looks(void);     /* calls of hal_image since the program began */
enum { FAKE_STACK_WORDS = 256 };         /* of each stack */
uint32_t* fake_hal_stack(unsigned stack);
unsigned fake_hal_stack_faults(void);
unsigned fake_hal_strobes(void);    /* of the hardware watchdog since power-on */
void fake_hal_fit(uint32_t fitted); /* changes the ICs without power-on */
/* The X word of a device at `address` reads as `value` whatever is written, until power-on. */
void fake_hal_stick(uint32_t address, uint32_t value);
void fake_hal_stop_clocks(bool stopped); /* no phase interrupt comes */

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

/* The word handed out last, which the code that runs has not touched yet: an interrupt leaves and returns to it. */
struct fake_word {
  uint32_t* at;
  struct fake_write before;
};
struct fake_word fake_hal_leave_word(void);
void fake_hal_return_to_word(struct fake_word left);

/* Power goes after so many writes to the flash store: those that come later are lost. The last one with power may be
 * torn: of these bits it leaves what was there. */
#define FAKE_POWER_STAYS 0xFFFFFFFFu
void fake_hal_power_goes(uint32_t after, uint32_t torn_bits);
uint32_t fake_hal_flash_writes(void); /* asked for since then */
uint32_t* fake_hal_flash(void);

#ifdef __cplusplus
}
#endif
/* NOLINTEND(modernize-*) */

#endif
