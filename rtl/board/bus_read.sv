// Read data of the register regions towards Port A: one sample a read, taken at the edge rd_i and held, so that no word
// is torn and none moves while the CPU looks. The pins are driven only while /RD is low, no other read has fallen since
// the one that the sample is of, and that was of these regions: the enable goes off with /RD, without a clock, and
// stays off for the on-chip page, which has no pins. Asynchronous reset. docs/port_a.md.
`default_nettype none

module bus_read (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        pa_rd_ni,
  input  wire logic [1:0]  rd_falls_i,  // of bus_strobes, as they are
  input  wire logic        rd_i,        // of bus_sync, and the count of that read
  input  wire logic [1:0]  of_i,
  input  wire logic        sel_any_i,   // a register region is selected
  input  wire logic        sel_int_i,   // it is the on-chip page
  input  wire logic [23:0] data_i,      // as the selected register stands
  output logic [23:0]      data_o,
  output logic             oe_o
);

  logic [23:0] data_q;
  logic [1:0]  of_q;
  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      data_q <= 24'h0;
      of_q   <= 2'd0;
    end else if (rd_i && sel_any_i) begin
      data_q <= data_i;
      of_q   <= of_i;
    end
  end

  logic low_n, oe_q;
  assign low_n = rst_ni & ~pa_rd_ni;
  always_ff @(posedge clk_ref_i or negedge low_n) begin
    if (!low_n)    oe_q <= 1'b0;
    else if (rd_i) oe_q <= sel_any_i & ~sel_int_i;
  end

  assign data_o = data_q;
  assign oe_o   = oe_q & (rd_falls_i == of_q);

endmodule : bus_read

`default_nettype wire
