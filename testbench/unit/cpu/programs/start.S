/* Start of the bare test programs: stack, main(), result to tohost (1 = passed, 2n+1 = main returned n). */
    .section .init, "ax"
    .globl _start
    .type _start, @function
_start:
    la sp, stack_top
    call main
    slli a0, a0, 1
    ori a0, a0, 1
    la t0, tohost
    sw a0, 0(t0)
1:  j 1b
    .size _start, . - _start

    .section .bss
    .balign 4096
    .space 16384
stack_top:
    .globl tohost
    .balign 4096
tohost:
    .space 8
