/* Hardware access. Device addresses come from the generated rtl/regs/brick_regs.h; memory map in docs/architecture.md.
 * The firmware reaches hardware through this header only, so that testbench/unit/firmware_platform can compile it for
 * the build machine with BRICK_NATIVE and put memory arrays behind it. */
#ifndef FIRMWARE_HAL_HAL_H
#define FIRMWARE_HAL_HAL_H

#include <stdbool.h>
#include <stdint.h>

#define HAL_WORD_MASK 0xFFFFFFu

#ifdef BRICK_NATIVE
volatile uint32_t* hal_x(uint32_t address);
volatile uint32_t* hal_y(uint32_t address);
uint32_t hal_cycles(void); /* CPU cycle counter, low 32 bits */
bool hal_real_time_pending(void);

typedef uint32_t hal_place;
static inline hal_place hal_place_of(uint32_t address) { return address; }
static inline volatile uint32_t* hal_x_of(hal_place place, uint32_t further) { return hal_x(place + further); }
static inline volatile uint32_t* hal_y_of(hal_place place, uint32_t further) { return hal_y(place + further); }
#else
static inline volatile uint32_t* hal_x(uint32_t address) { return (volatile uint32_t*)(0xC0000004u + 8u * address); }
static inline volatile uint32_t* hal_y(uint32_t address) { return (volatile uint32_t*)(0xC0000000u + 8u * address); }

/* Words that stand together: the address of the first stays in a register, those of the others are not worked out. */
typedef volatile uint32_t* hal_place;
static inline hal_place hal_place_of(uint32_t address) {
  hal_place place = hal_y(address);
  __asm__("" : "+r"(place));
  return place;
}
static inline volatile uint32_t* hal_x_of(hal_place place, uint32_t further) { return place + 2u * further + 1u; }
static inline volatile uint32_t* hal_y_of(hal_place place, uint32_t further) { return place + 2u * further; }

#define HAL_CSR(text) ".option push\n.option arch, +zicsr\n" text "\n.option pop\n"

static inline uint32_t hal_cycles(void) {
  uint32_t cycles;
  __asm__ volatile(HAL_CSR("csrr %0, mcycle") : "=r"(cycles));
  return cycles;
}
static inline bool hal_real_time_pending(void) {
  uint32_t bits;
  __asm__ volatile(HAL_CSR("csrr %0, mip") : "=r"(bits));
  return (bits & 1u << 19) != 0u;
}
#endif

/* A 24-bit word as a signed number. */
static inline int32_t hal_signed(uint32_t word) { return (int32_t)(word << 8) >> 8; }

/* Critical sections. The state returned by the first call is given back to the second. */
uint32_t hal_mask_real_time(void); /* holds off the real-time task (background use) */
uint32_t hal_mask_servo(void);     /* holds off servo and real-time tasks */
uint32_t hal_mask_all(void);       /* holds off every task and the host port */
void hal_unmask(uint32_t state);

uint64_t hal_long_cycles(void);                      /* all of it */
const uint32_t* hal_image(uint32_t* words);          /* code and constants, and how many words they have */
void hal_delay_us(uint32_t us);                      /* busy wait, 10 % longer at most */
void hal_await_us(uint32_t start, uint32_t us);      /* the same, counted from hal_cycles() = `start` */
void hal_host_signals(uint32_t set, uint32_t clear); /* bits HAL_SIGNAL_*: latch X:$070010 */
enum { HAL_SIGNAL_IPOS = 1, HAL_SIGNAL_BREQ = 2, HAL_SIGNAL_EROR = 4, HAL_SIGNAL_F1ER = 8 };

/* Kernel only. ----------------------------------------------------------------------------------------------------- */
void hal_set_cpu_clock(uint32_t i52); /* cycles a microsecond for hal_delay_us and hal_cycles_per_ms */
uint32_t hal_cycles_per_ms(void);
void hal_interrupts_off(void);                /* no task enabled, nothing latched */
void hal_interrupts_on(void);                 /* all tasks enabled; clock edges and requests until now forgotten */
void hal_request_real_time(void);             /* sets the real-time interrupt pending */
void hal_idle(const volatile uint32_t* work); /* sleeps until the next interrupt unless *work is not zero already */
void hal_watchdog_strobe(void);
void hal_host_interrupts(bool receive, bool transmit); /* HRIE, HTIE of the host port */
void hal_clear_words(uint32_t first, uint32_t count);  /* X and Y words of main memory */
bool hal_servo_pending(void);                          /* the next servo interrupt waits already */

/* A stack beside that of the background and the interrupts: what runs on it can be left in the middle of any function
 * and gone on with later, or forgotten. Natively it is not left: the change to it runs `task` to its end. */
void hal_side_begin(void (*task)(void)); /* the next change calls `task` anew, each one after its end again */
void hal_side_change(void);              /* to the side stack, or back from it */

/* Straps, read-only words of the board description. */
enum {
  HAL_STRAP_E3 = 0,
  HAL_STRAP_FITTED,
  HAL_STRAP_CARD,
  HAL_STRAP_DPRAM_WORDS,
  HAL_STRAP_POWER_ON,
  HAL_STRAP_PRODUCT
};
enum {
  HAL_PRODUCT_JPAN = 1,
  HAL_PRODUCT_UMAC = 2,
  HAL_PRODUCT_ULTRALITE = 4,
  HAL_PRODUCT_TURBO_PMAC_1 = 8,
  HAL_PRODUCT_FEEDBACK_2 = 16, /* a Geo PMAC has its SSI inputs */
  HAL_PRODUCT_GEO_PMAC = 32
};
uint32_t hal_strap(unsigned word);

/* Flash store: plain memory, erased to all ones. A word is written whole, words in the order of the calls; power may go
 * between any two. */
enum { HAL_FLASH_BYTES = 0x100000 };
const uint32_t* hal_flash(void);
void hal_flash_write(uint32_t word, uint32_t value);

#endif
