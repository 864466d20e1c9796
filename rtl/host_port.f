// Host port HI08: what host_port is made of, in compile order.
// Written by tools/rtl_cores.py from the RTL (./dev cores). Do not edit.
regs/brick_regs_pkg.sv
host/host_port.sv
