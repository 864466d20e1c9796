/* Trap entries. A task may be interrupted by higher ones only: host port (18) > phase (16) > servo (17) > real-time
 * (19). Each entry saves the caller-saved registers, mepc and mie, leaves in mie only what stands above it, enables
 * interrupts, calls the C handler and restores. mstatus need not be saved: a trap is only ever taken with MIE set, so
 * MPIE is always 1 on return. Latched interrupts are cleared before the handler runs, so that an edge during the
 * handler counts. */
#include "firmware/host/host_port.h"
#include "rtl/regs/brick_regs.h"

  .option push
  .option arch, +zicsr

  .equ PHASE, 1 << 16
  .equ SERVO, 1 << 17
  .equ HOST, 1 << 18
  .equ REAL_TIME, 1 << 19
  .equ FRAME, 80

  .equ HOST_REGISTERS, 0xC0000000 + 8 * (HI08_X_HSR) /* hal_x without its last 4 */
  .equ HOST_CONTROL, 4 + 8 * ((HI08_X_HCR) - (HI08_X_HSR))
  .equ HOST_STATUS, 4
  .equ HOST_CHARACTER, 4 + 8 * ((HI08_X_HORX) - (HI08_X_HSR))

  .macro save_registers
  addi sp, sp, -FRAME
  sw ra, 0(sp)
  sw t0, 4(sp)
  sw t1, 8(sp)
  sw t2, 12(sp)
  sw a0, 16(sp)
  sw a1, 20(sp)
  sw a2, 24(sp)
  sw a3, 28(sp)
  sw a4, 32(sp)
  sw a5, 36(sp)
  sw a6, 40(sp)
  sw a7, 44(sp)
  sw t3, 48(sp)
  sw t4, 52(sp)
  sw t5, 56(sp)
  sw t6, 60(sp)
  .endm

  .macro restore_registers
  lw ra, 0(sp)
  lw t0, 4(sp)
  lw t1, 8(sp)
  lw t2, 12(sp)
  lw a0, 16(sp)
  lw a1, 20(sp)
  lw a2, 24(sp)
  lw a3, 28(sp)
  lw a4, 32(sp)
  lw a5, 36(sp)
  lw a6, 40(sp)
  lw a7, 44(sp)
  lw t3, 48(sp)
  lw t4, 52(sp)
  lw t5, 56(sp)
  lw t6, 60(sp)
  addi sp, sp, FRAME
  .endm

  /* mie keeps only what it had and what `above` allows: a critical section of the interrupted task stays in force. */
  .macro task name, line, above, handler
  .global \name
\name:
  save_registers
  csrr t0, mepc
  csrr t1, mie
  sw t0, 64(sp)
  sw t1, 68(sp)
  li t2, \line
  csrc mip, t2
  li t2, \above
  and t2, t2, t1
  csrw mie, t2
  csrsi mstatus, 8
  call \handler
  csrci mstatus, 8
  lw t0, 64(sp)
  lw t1, 68(sp)
  csrw mepc, t0
  csrw mie, t1
  restore_registers
  mret
  .endm

  .section .text.trap, "ax"
  .balign 256
  .global trap_vector
trap_vector:
  .option push
  .option norvc
  j trap_exception
  .rept 15
  j trap_exception
  .endr
  j trap_phase                  /* 16 */
  j trap_servo                  /* 17 */
  j trap_host                   /* 18 */
  j trap_real_time              /* 19 */
  .option pop

  /* Nine thousand times a second: as short as it can be. */
  .global trap_phase
trap_phase:
  addi sp, sp, -16
  sw t0, 0(sp)
  sw t1, 4(sp)
  li t0, PHASE
  csrc mip, t0
  csrr t0, mcycle
  sw t0, tasks_phase_stamp, t1
  lw t1, motors_enabled
  beqz t1, 2f
  sw zero, host_port_granted, t1
  li t0, 1
  sw t0, host_port_renewed, t1
  lw t1, host_port_held
  bnez t1, 3f
2:
  lw t1, phase_task_work
  bnez t1, 1f
  lw t0, 0(sp)
  lw t1, 4(sp)
  addi sp, sp, 16
  mret
1:
  lw t0, 0(sp)
  lw t1, 4(sp)
  addi sp, sp, 16
  j trap_phase_work
3:                              /* characters have been waiting for this */
  sw zero, host_port_held, t1
  lw t0, host_port_enables
  li t1, HOST_REGISTERS
  sw t0, HOST_CONTROL(t1)
  j 2b

  task trap_phase_work, 0, HOST, phase_task_interrupt
  task trap_servo, SERVO, HOST | PHASE, tasks_servo_interrupt
  task trap_real_time, REAL_TIME, HOST | PHASE | SERVO, tasks_real_time_interrupt

  /* The host port is the highest task: it runs with interrupts off. A character of a line goes to its queue here, as
   * short as it can be: a host writes one every 2 us, and what compiles the line has the rest. Everything else, a full
   * queue and a queue that is sent as well, is host/host_port.c's. */
  .macro leave_short_frame
  lw t0, 0(sp)
  lw t1, 4(sp)
  lw t2, 8(sp)
  lw t3, 12(sp)
  addi sp, sp, 32
  .endm

  .global trap_host
trap_host:
  addi sp, sp, -32
  sw t0, 0(sp)
  sw t1, 4(sp)
  sw t2, 8(sp)
  sw t3, 12(sp)
  li t0, HOST_REGISTERS
  lw t1, HOST_STATUS(t0)
  andi t1, t1, HI08_HSR_HRDF_MASK
  beqz t1, 1f
  lw t2, host_port_received_count
  lw t3, host_port_granted
  blez t3, 1f
  lw t1, HOST_CHARACTER(t0)
  addi t3, t3, -1
  sw t3, host_port_granted, t0
  andi t1, t1, 0xFF
  li t3, ' '
  bltu t1, t3, 2f
3:
  lla t3, host_port_received
  slli t0, t2, 32 - HOST_PORT_RECEIVE_BITS
  srli t0, t0, 32 - HOST_PORT_RECEIVE_BITS
  add t3, t3, t0
  sb t1, 0(t3)
  addi t2, t2, 1
  sw t2, host_port_received_count, t3
  sw t1, slice_hurry, t3
  leave_short_frame
  mret
1:
  leave_short_frame
  save_registers
  call host_port_interrupt
  restore_registers
  mret
2:
  li t3, '\r'
  bne t1, t3, 4f
  sw t3, background_work, t0
  j 3b
4:                              /* another control character, in a word that neither frame uses otherwise */
  sw t1, 28(sp)
  leave_short_frame
  save_registers
  lw a0, FRAME - 4(sp)
  call host_port_character
  restore_registers
  mret

  /* Nothing but these interrupts is meant to come: an access where nothing answers, an instruction that there is not.
   * What the task was about cannot go on and is not gone back to. */
  .global trap_exception
trap_exception:
  csrw mie, zero
  la sp, __stack_top
  csrr a0, mcause
  csrr a1, mepc
  csrr a2, mtval
  call fault_take
  beqz a0, 1f
  j _start
1:
  j 1b                          /* the hardware watchdog is not strobed any more */
  .option pop
