// Dual-ported RAM: what dpram is made of, in compile order.
// Written by tools/rtl_cores.py from the RTL (./dev cores). Do not edit.
common/sync2.sv
host/dpram_memory.sv
host/dpram.sv
