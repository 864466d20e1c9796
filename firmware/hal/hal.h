/* Hardware access. Device addresses come from the generated rtl/regs/brick_regs.h; memory map in docs/architecture.md. */
#ifndef FIRMWARE_HAL_HAL_H
#define FIRMWARE_HAL_HAL_H

#include <stdbool.h>
#include <stdint.h>

#define HAL_WORD_MASK 0xFFFFFFu

static inline volatile uint32_t *hal_x(uint32_t address) { return (volatile uint32_t *)(0xC0000004u + 8u * address); }
static inline volatile uint32_t *hal_y(uint32_t address) { return (volatile uint32_t *)(0xC0000000u + 8u * address); }

/* Critical sections. The state returned by the first call is given back to the second. */
uint32_t hal_mask_real_time(void);          /* holds off the real-time task (background use) */
uint32_t hal_mask_servo(void);              /* holds off servo and real-time tasks */
void hal_unmask(uint32_t state);

uint32_t hal_cycles(void);                  /* CPU cycle counter, low 32 bits */
void hal_delay_us(uint32_t us);             /* busy wait */
void hal_host_signals(uint32_t set, uint32_t clear);   /* bits HAL_SIGNAL_*: latch X:$070010 */
enum { HAL_SIGNAL_IPOS = 1, HAL_SIGNAL_BREQ = 2, HAL_SIGNAL_EROR = 4, HAL_SIGNAL_F1ER = 8 };

#endif
