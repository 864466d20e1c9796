// Serial encoder inputs (SSI): what ssi is made of, in compile order.
// Written by tools/rtl_cores.py from the RTL (./dev cores). Do not edit.
ssi/ssi_edges.sv
ssi/ssi_group.sv
common/sync2.sv
ssi/ssi_channel_regs.sv
ssi/ssi_channel.sv
ssi/ssi.sv
