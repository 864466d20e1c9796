/* The hardware behind hal.h on the modelled board: machine-mode CSRs, straps, flash and the bus-control latches. */
#include "firmware/hal/hal.h"

#include "firmware/hal/stacks.h"
#include "rtl/regs/brick_regs.h"

/* mie and mip bits, docs/architecture.md "Interrupts". */
#define TASK_PHASE (1u << 16)
#define TASK_SERVO (1u << 17)
#define TASK_HOST (1u << 18)
#define TASK_REAL_TIME (1u << 19)
#define TASK_ALL (TASK_PHASE | TASK_SERVO | TASK_HOST | TASK_REAL_TIME)

static uint32_t cycles_per_ms = 78643u; /* 8 x 9.8304 MHz until I52 is known */
static uint32_t cycles_per_us = 79u;    /* rounded up */
static uint32_t host_signals;
static uint32_t watchdog_phase;

static uint32_t mie_clear(uint32_t bits) {
  uint32_t old;
  __asm__ volatile(HAL_CSR("csrrc %0, mie, %1") : "=r"(old) : "r"(bits) : "memory");
  return old;
}

uint32_t hal_mask_real_time(void) { return mie_clear(TASK_REAL_TIME); }
uint32_t hal_mask_servo(void) { return mie_clear(TASK_REAL_TIME | TASK_SERVO); }
uint32_t hal_mask_all(void) { return mie_clear(TASK_ALL); }
void hal_unmask(uint32_t state) { __asm__ volatile(HAL_CSR("csrw mie, %0") : : "r"(state) : "memory"); }

uint64_t hal_long_cycles(void) {
  uint32_t high, low, again;
  do {
    __asm__ volatile(HAL_CSR("csrr %0, mcycleh") : "=r"(high));
    low = hal_cycles();
    __asm__ volatile(HAL_CSR("csrr %0, mcycleh") : "=r"(again));
  } while (again != high);
  return ((uint64_t)high << 32) | low;
}

const uint32_t* hal_image(uint32_t* words) {
  const uint32_t *begin, *end; /* symbols of image/turbo.ld */
  __asm__("la %0, __code_start" : "=r"(begin));
  __asm__("la %0, __code_end" : "=r"(end));
  *words = (uint32_t)(end - begin);
  return begin;
}

void hal_set_cpu_clock(uint32_t i52) {
  cycles_per_ms = (98304u * (i52 + 1u)) / 10u;
  cycles_per_us = cycles_per_ms / 1000u + 1u;
}
uint32_t hal_cycles_per_ms(void) { return cycles_per_ms; }

void hal_delay_us(uint32_t us) { hal_await_us(hal_cycles(), us); }

void hal_await_us(uint32_t start, uint32_t us) {
  const uint32_t cycles = us * cycles_per_us; /* no division: tasks are held off while BREQ pulses */
  while (hal_cycles() - start < cycles) {}
}

void hal_host_signals(uint32_t set, uint32_t clear) {
  const uint32_t state = hal_mask_servo();
  const uint32_t next = (host_signals & ~clear) | set;
  if (next != host_signals) {
    host_signals = next;
    *hal_x(BOARD_LATCHES_X_HOST_SIGNALS) = next;
  }
  hal_unmask(state);
}

void hal_interrupts_off(void) {
  (void)mie_clear(~0u);
  __asm__ volatile(HAL_CSR("csrc mip, %0") : : "r"(TASK_ALL) : "memory");
}

/* A clock edge of the time before counts no more: taken late, its task could run into the next one (servo error). */
void hal_interrupts_on(void) {
  __asm__ volatile(HAL_CSR("csrc mip, %0") : : "r"(TASK_PHASE | TASK_SERVO | TASK_REAL_TIME) : "memory");
  __asm__ volatile(HAL_CSR("csrs mie, %0\n csrsi mstatus, 8") : : "r"(TASK_ALL) : "memory");
}

void hal_request_real_time(void) { __asm__ volatile(HAL_CSR("csrs mip, %0") : : "r"(TASK_REAL_TIME) : "memory"); }

static uint32_t pending(void) {
  uint32_t bits;
  __asm__ volatile(HAL_CSR("csrr %0, mip") : "=r"(bits));
  return bits;
}

bool hal_servo_pending(void) { return (pending() & TASK_SERVO) != 0u; }

/* With mstatus.MIE clear an interrupt that arrives between the test and WFI still ends the sleep, and is taken
 * afterwards. */
void hal_idle(const volatile uint32_t* work) {
  __asm__ volatile(HAL_CSR("csrci mstatus, 8") : : : "memory");
  if (*work == 0u) __asm__ volatile("wfi" : : : "memory");
  __asm__ volatile(HAL_CSR("csrsi mstatus, 8") : : : "memory");
}

void hal_watchdog_strobe(void) {
  watchdog_phase ^= 1u;
  *hal_x(BOARD_LATCHES_X_WATCHDOG_STROBE) = watchdog_phase;
}

void hal_host_interrupts(bool receive, bool transmit) {
  *hal_x(HI08_X_HCR) = (receive ? HI08_HCR_HRIE_MASK : 0u) | (transmit ? HI08_HCR_HTIE_MASK : 0u);
}

/* X and Y of an address lie side by side; eight stores a turn, because start-up clears 67,584 addresses. */
/* Most of a start is this: 32 stores a turn. */
void hal_clear_words(uint32_t first, uint32_t count) {
  volatile uint32_t* at = hal_y(first);
  volatile uint32_t* end = hal_y(first + count);
  for (; end - at >= 32; at += 32) {
    at[0] = at[1] = at[2] = at[3] = at[4] = at[5] = at[6] = at[7] = 0;
    at[8] = at[9] = at[10] = at[11] = at[12] = at[13] = at[14] = at[15] = 0;
    at[16] = at[17] = at[18] = at[19] = at[20] = at[21] = at[22] = at[23] = 0;
    at[24] = at[25] = at[26] = at[27] = at[28] = at[29] = at[30] = at[31] = 0;
  }
  for (; at < end; ++at) *at = 0;
}

enum { FRAME_WORDS = 16 }; /* of exchange_stacks */

/* A call that comes back when the other side makes it: what a C function keeps goes to the present stack, whose pointer
 * is exchanged with *other. */
static __attribute__((naked, noipa)) void exchange_stacks(uint32_t** other __attribute__((unused))) {
  __asm__ volatile(
      "addi sp, sp, -64\n"
      "sw ra, 0(sp)\n sw s0, 4(sp)\n sw s1, 8(sp)\n sw s2, 12(sp)\n"
      "sw s3, 16(sp)\n sw s4, 20(sp)\n sw s5, 24(sp)\n sw s6, 28(sp)\n"
      "sw s7, 32(sp)\n sw s8, 36(sp)\n sw s9, 40(sp)\n sw s10, 44(sp)\n"
      "sw s11, 48(sp)\n"
      "lw t0, 0(a0)\n sw sp, 0(a0)\n mv sp, t0\n"
      "lw ra, 0(sp)\n lw s0, 4(sp)\n lw s1, 8(sp)\n lw s2, 12(sp)\n"
      "lw s3, 16(sp)\n lw s4, 20(sp)\n lw s5, 24(sp)\n lw s6, 28(sp)\n"
      "lw s7, 32(sp)\n lw s8, 36(sp)\n lw s9, 40(sp)\n lw s10, 44(sp)\n"
      "lw s11, 48(sp)\n"
      "addi sp, sp, 64\n ret");
}

static uint32_t* other_stack; /* stack pointer of the side that does not run */
static void (*side_task)(void);

static _Noreturn void side_main(void) {
  for (;;) {
    side_task();
    exchange_stacks(&other_stack);
  }
}

void hal_side_begin(void (*task)(void)) {
  uint32_t words;
  const volatile uint32_t* bottom = hal_stack(STACK_SLICES, &words);
  side_task = task;
  other_stack = (uint32_t*)(uintptr_t)bottom + words - FRAME_WORDS;
  *other_stack = (uint32_t)&side_main; /* the return address */
}

void hal_side_change(void) { exchange_stacks(&other_stack); }

uint32_t hal_strap(unsigned word) { return ((const volatile uint32_t*)0x3FFFF000u)[word]; }
#define FLASH_BASE 0x30000000u

const uint32_t* hal_flash(void) { return (const uint32_t*)FLASH_BASE; }
void hal_flash_write(uint32_t word, uint32_t value) { ((volatile uint32_t*)FLASH_BASE)[word] = value; }
