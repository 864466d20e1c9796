// Slave on the ISA bus: what isa_slave is made of, in compile order.
// Written by tools/rtl_cores.py from the RTL (./dev cores). Do not edit.
regs/brick_regs_pkg.sv
common/sync2.sv
host/isa_slave.sv
