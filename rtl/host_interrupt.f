// Interrupt line of the host bus: what host_interrupt is made of, in compile order.
// Written by tools/rtl_cores.py from the RTL (./dev cores). Do not edit.
host/host_interrupt.sv
