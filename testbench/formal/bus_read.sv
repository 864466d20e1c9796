// Rules of the read data towards Port A, host-bus:2.6/3 and host-bus:2.6/5, with the strobes' counters as they are:
// when the board drives D, and what. A step is half a period of clk_ref; /RD may change at any, and an edge takes what
// stood a step before it. When a read is taken, of which count and of what region is free. Nothing is assumed but that
// a run starts in reset.
// proof: pdr
// clocks: several
// steps: 16
// fault R1: the end of /RD does not turn the pins off (rtl/board/bus_read.sv)
//   - assign low_n = rst_ni & ~pa_rd_ni;
//   + assign low_n = rst_ni;
// fault R2: the on-chip page drives the pins (rtl/board/bus_read.sv)
//   - oe_q <= sel_any_i & ~sel_int_i;
//   + oe_q <= sel_any_i;
// fault R4: the next read shows the sample of the one before (rtl/board/bus_read.sv)
//   - oe_q & (rd_falls_i == of_q);
//   + oe_q;
`default_nettype none

module bus_read_rules (
  input wire logic        rst_ni,
  input wire logic        rd_ni,
  input wire logic        taken_i,
  input wire logic [1:0]  of_i,
  input wire logic        any_i,
  input wire logic        on_chip_i,
  input wire logic [23:0] data_i
);

  logic clk_q = 1'b0, started_q = 1'b0, rd_nq = 1'b1;
  always @($global_clock) {clk_q, started_q, rd_nq} <= {~clk_q, 1'b1, rd_ni};
  // guarantee: power-on
  always_comb assume (started_q || !rst_ni);
  always_comb assume (started_q || rd_ni);

  logic [1:0]  rd_falls, wr_falls;
  logic [23:0] data;
  logic        oe;
  bus_strobes strobes (.rst_ni, .pa_rd_ni(rd_ni), .pa_wr_ni(1'b1), .rd_falls_o(rd_falls), .wr_falls_o(wr_falls));
  bus_read dut (.clk_ref_i(clk_q), .rst_ni, .pa_rd_ni(rd_ni), .rd_falls_i(rd_falls), .rd_i(taken_i), .of_i,
                .sel_any_i(any_i), .sel_int_i(on_chip_i), .data_i, .data_o(data), .oe_o(oe));

  // The last read that was taken since /RD fell, as the edge of clk_ref found it, an edge with /RD low.
  logic        own_q = 1'b0;
  logic [1:0]  of_q;
  logic [23:0] data_q;
  always @($global_clock) begin
    if (rd_ni) own_q <= 1'b0;
    else if (!clk_q && taken_i) {own_q, of_q, data_q} <= {any_i & ~on_chip_i, of_i, data_i};
  end

  always @($global_clock) if (rst_ni) begin
    // R1: D is driven only while /RD is low: it goes off with it, without a clock.
    if (oe) begin
      R1: assert (!rd_ni);
      C1: cover (data != 24'h0);
    end

    // R2: It is driven only for a read that was taken since /RD fell, of a region of the board's own with pins.
    if (oe) begin
      R2: assert (own_q && !rd_ni);
      C2: cover (!rd_nq);
    end

    // R3: What it shows is the word as that read took it, and stands.
    if (oe) begin
      R3: assert (data == data_q);
      C3: cover (data != data_i);
    end

    // R4: It is not driven once another read has fallen since the one that the sample is of.
    if (oe) begin
      R4: assert (of_q == rd_falls);
      C4: cover (rd_falls == 2'd2);
    end
  end

endmodule : bus_read_rules

`default_nettype wire
