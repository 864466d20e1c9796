/* Firmware for the benchmark: nothing but reads of gate IC registers, at the factory wait states, and the strobe that
 * the watchdog wants. The clocks run; no interrupt is enabled. A round is 64 accesses and 65 instructions. */
  .text
  .global _start
_start:
  li s0, 0xC0000004 + 8 * 0x070000
  li s1, 0xC0000004 + 8 * 0x078000
  li t0, 0x0FECE1               /* wait states: AA0 1, AA1 7, AA2 3, AA3 7, default 15 */
  li t1, 0xC0000004 + 8 * 0xFFFFFB
  sw t0, 0(t1)
  li t0, 0x3008D2               /* clock source: servo IC 0 */
  sw t0, 8 * 4(s1)
1:
  .rept 15                      /* status, phase and servo position of channel 1, status of channel 2 */
  lw t0, 8 * 0x00(s1)
  lw t1, 8 * 0x01(s1)
  lw t2, 8 * 0x02(s1)
  lw t3, 8 * 0x08(s1)
  .endr
  lw t0, 8 * 0x00(s1)
  lw t1, 8 * 0x01(s1)
  lw t2, 8 * 0x02(s1)
  sw zero, 8 * 0x11(s0)         /* watchdog strobe */
  j 1b
