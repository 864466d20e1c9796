/* Reads and writes where nothing answers: the causes are left in Y:$000100 and Y:$000101, then 1 in Y:$000102. */
  .option arch, +zicsr
  .option norvc
  .section .init, "ax"
  .global _start
_start:
  li s3, 0xC0000000 + 8 * 0x000100
  la t0, trap
  csrw mtvec, t0
  li t1, 0xC0000004 + 8 * 0x040000
  lw t0, 0(t1)
  sw t6, 0(s3)
  sw t0, 0(t1)
  sw t6, 8(s3)
  li t1, 0xC0000004 + 8 * 0x078000
  sb t0, 0(t1)                  /* the bus knows whole words only */
  sw t6, 24(s3)
  li t0, 1
  sw t0, 16(s3)
1:
  wfi
  j 1b
  .balign 4
trap:
  csrr t6, mcause
  csrr t5, mepc
  addi t5, t5, 4
  csrw mepc, t5
  mret
