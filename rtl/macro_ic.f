// MACRO IC (DSPGATE2), clock part: what macro_ic is made of, in compile order.
// Written by tools/rtl_cores.py from the RTL (./dev cores). Do not edit.
regs/brick_regs_pkg.sv
macro_ic/macro_ic_regs.sv
common/sync2.sv
servo_ic/clock_gen.sv
macro_ic/macro_ic.sv
