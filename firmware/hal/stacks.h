/* The two stacks: that of the background and of all interrupts, and that of work in slices (hal_side_change). crt0.S
 * fills both with marks, so that what a stack has never used can be told; the lowest words are a guard that nothing may
 * use. The stack of slices begins at the lowest address of RAM: what goes beyond it faults at once. */
#ifndef FIRMWARE_HAL_STACKS_H
#define FIRMWARE_HAL_STACKS_H

#define STACK_MARK 0xA5C3963Cu

#ifndef __ASSEMBLER__
#include <stdbool.h>
#include <stdint.h>

enum stack { STACK_MAIN, STACK_SLICES, STACK_COUNT };

enum { STACK_GUARD_WORDS = 4 };

/* Lowest word first. */
const volatile uint32_t* hal_stack(enum stack stack, uint32_t* words);
bool hal_stack_guards_hold(void);
void hal_stack_fault(void); /* a guard is damaged: a fault of the firmware (image/fault.h), does not return */
#endif

#endif
