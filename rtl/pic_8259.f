// Interrupt controller 8259: what pic_8259 is made of, in compile order.
// Written by tools/rtl_cores.py from the RTL (./dev cores). Do not edit.
regs/brick_regs_pkg.sv
common/sync2.sv
host/pic_8259.sv
