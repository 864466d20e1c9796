// Interrupt controller of the host: what interrupt_controller is made of, in compile order.
// Written by tools/rtl_cores.py from the RTL (./dev cores). Do not edit.
regs/brick_regs_pkg.sv
common/sync2.sv
host/interrupt_controller.sv
