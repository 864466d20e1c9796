/* Guards and high-water marks of the stacks (hal/stacks.h). */
#ifndef FIRMWARE_KERNEL_STACK_WATCH_H
#define FIRMWARE_KERNEL_STACK_WATCH_H

void stack_watch_check(void); /* real-time task: a damaged guard is a fault */
void stack_watch_pass(void);  /* background: a part of both is looked at, the result stands at MEMORY_STACKS */

#endif
