/* Reset entry of the image: stack, global pointer, trap vector, initialised data from the code region, zeroed data,
 * marks in both stacks, image_main. */
#include "firmware/hal/stacks.h"

  .option push
  .option arch, +zicsr
  .section .init, "ax"
  .global _start
_start:
  .option push
  .option norelax
  la gp, __global_pointer$
  .option pop
  la sp, __stack_top
  la t0, trap_vector
  ori t0, t0, 1                 /* vectored: each interrupt has an entry of its own */
  csrw mie, zero
  csrw mtvec, t0

  la a0, __data_load
  la a1, __data_start
  la a2, __data_end
1:
  bgeu a1, a2, 2f
  lw t0, 0(a0)
  sw t0, 0(a1)
  addi a0, a0, 4
  addi a1, a1, 4
  j 1b
2:
  la a1, __bss_start
  la a2, __bss_end
  j 4f
3:                              /* the linker script rounds .bss to 64 bytes */
  .irp word, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15
  sw zero, 4*\word(a1)
  .endr
  addi a1, a1, 64
4:
  bltu a1, a2, 3b
  li t0, STACK_MARK             /* of 16 bytes each as well */
  la a1, __side_stack_bottom
  la a2, __side_stack_top
  call 6f
  la a1, __stack_bottom
  la a2, __stack_top
  call 6f
  call image_main
5:
  j 5b
6:
  sw t0, 0(a1)
  sw t0, 4(a1)
  sw t0, 8(a1)
  sw t0, 12(a1)
  addi a1, a1, 16
  bltu a1, a2, 6b
  ret
  .option pop
