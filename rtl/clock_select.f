// Choice of the ICs that drive PHASE and SERVO: what clock_select is made of, in compile order.
// Written by tools/rtl_cores.py from the RTL (./dev cores). Do not edit.
regs/brick_regs_pkg.sv
common/sync2.sv
board/clock_select.sv
