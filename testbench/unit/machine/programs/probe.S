/* A small firmware for tests of the machine. Registers that live through everything:
 *   s0 PMAC base of X:$070000, s1 address of X:$078000, s2 address of X:$FFFFC0, s3 main memory Y:$000100, s4 counter
 *   of background loops, s5 straps.
 * It starts the clocks, then the background either sleeps (main memory Y:$000100 = 0) or counts and uses the bus. PHASE
 * writes its count to X:$070010 as the very first instruction, so that a test can compute when that cycle begins. SERVO
 * strobes the watchdog unless Y:$000101 is set. A character from the host comes back incremented, and goes to the
 * DPRAM.
 */
  .option arch, +zicsr
  .section .init, "ax"
  .global _start
_start:
  li s0, 0xC0000004 + 8 * 0x070000
  li s1, 0xC0000004 + 8 * 0x078000
  li s2, 0xC0000004 + 8 * 0xFFFFC0
  li s3, 0xC0000000 + 8 * 0x000100
  li s5, 0x3FFFF000
  li s6, 0xC0000000 + 8 * 0x060000
  li s4, 0
  li s7, 0                      /* phase interrupts */
  li s8, 0                      /* servo interrupts */
  li t0, 0x1F0FE7               /* wait states: AA0 7, AA1 31, AA2 3, AA3 0, default 31 */
  li t1, 0xC0000004 + 8 * 0xFFFFFB
  sw t0, 0(t1)
  lw t0, 16(s5)                 /* power-on or reset */
  beqz t0, 1f
  sw zero, 0(s3)                /* RAM is random at power-on */
  sw zero, 8(s3)
1:
  lw t0, 16(s5)
  sw t0, 0x18(s3)               /* Y:$000103: kind of start */
  lw t0, 0(s5)
  sw t0, 0x20(s3)               /* Y:$000104: jumper */
  la t0, vector
  ori t0, t0, 1
  csrw mtvec, t0
  li t0, 1                      /* host receive interrupt on */
  sw t0, 8 * 2(s2)              /* X:$FFFFC2 */
  li t0, 0x0A0F07               /* short clocks */
  li t1, 0x000F
  li t0, (200 << 8) | 15        /* phase every 403 ticks */
  sw t0, 8 * 0x1C(s1)
  li t0, 0x3008D2               /* clock source: servo IC 0, servo = phase / 4 */
  sw t0, 8 * 4(s1)
  li t0, 0x70000                /* phase, servo, host */
  csrw mie, t0
  csrsi mstatus, 8
background:
  lw t0, 0(s3)
  bnez t0, 2f
  wfi
  j background
2:
  addi s4, s4, 1
  sw s4, 0x10(s3)               /* Y:$000102: loops */
  andi t0, s4, 15
  bnez t0, background
  sw s4, 8 * 5(s6)              /* DPRAM Y:$060005 */
  lw t1, 8 * 5(s6)
  lw t0, 8 * 4(s1)              /* gate IC */
  j background

  .balign 256
  .option push
  .option norvc
vector:
  j exception
  .rept 15
  j vector
  .endr
  j phase
  j servo
  j host
  .option pop

phase:
  sw s7, 8 * 0x10(s0)           /* X:$070010: first instruction after one jump */
  addi s7, s7, 1
  li t5, 0x10000
  csrc mip, t5
  mret

servo:
  li t5, 0x20000
  csrc mip, t5
  addi s8, s8, 1
  lw t5, 8(s3)
  bnez t5, 1f
  sw s8, 8 * 0x11(s0)           /* watchdog */
1:
  mret

host:
  lw t6, 8 * 6(s2)              /* HORX */
  sw t6, 0(s6)                  /* DPRAM Y:$060000 */
  addi t6, t6, 1
  sw t6, 8 * 7(s2)              /* HOTX */
  mret

exception:
  csrr t5, mcause
  sw t5, 0x28(s3)               /* Y:$000105 */
  csrr t5, mepc
  addi t5, t5, 4
  csrw mepc, t5
  mret
