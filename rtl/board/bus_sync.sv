// Port A synchroniser: the falls of /RD and /WR, each as a level that turns over (bus_strobes), pass two flip-flops on
// clk_ref_i; a third finds the edge. we_o, rd_o: the one edge at which a write is made, at which a read takes its
// sample and has its side effects, the third after the fall. Address and data are sampled freely; those that stand here
// then were sampled an edge before, when the strobe had been low for a period, and are stable. Asynchronous reset.
// docs/port_a.md.
`default_nettype none

module bus_sync (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        rd_toggle_i,
  input  wire logic        wr_toggle_i,
  input  wire logic [18:0] pa_addr_i,
  input  wire logic        pa_x_i,
  input  wire logic [3:0]  pa_aa_i,
  input  wire logic        pa_int_i,
  input  wire logic [23:0] pa_wdata_i,
  output logic [18:0]      addr_o,
  output logic             x_o,
  output logic [3:0]       aa_o,
  output logic             int_o,
  output logic [23:0]      wdata_o,
  output logic             we_o,
  output logic             rd_o
);

  (* async_reg = "true" *) logic rd1_q, rd2_q, wr1_q, wr2_q;  // only the second stage looks at the first
  logic        rd3_q, wr3_q;
  logic [24:0] where_q;  // {int, aa, x, addr}
  logic [23:0] wdata_q;

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      rd1_q   <= 1'b0;
      rd2_q   <= 1'b0;
      rd3_q   <= 1'b0;
      wr1_q   <= 1'b0;
      wr2_q   <= 1'b0;
      wr3_q   <= 1'b0;
      where_q <= 25'h0;
      wdata_q <= 24'h0;
    end else begin
      rd1_q   <= rd_toggle_i;
      rd2_q   <= rd1_q;
      rd3_q   <= rd2_q;
      wr1_q   <= wr_toggle_i;
      wr2_q   <= wr1_q;
      wr3_q   <= wr2_q;
      where_q <= {pa_int_i, pa_aa_i, pa_x_i, pa_addr_i};
      wdata_q <= pa_wdata_i;
    end
  end

  assign {int_o, aa_o, x_o, addr_o} = where_q;
  assign wdata_o = wdata_q;
  assign we_o    = wr2_q ^ wr3_q;
  assign rd_o    = rd2_q ^ rd3_q;

endmodule : bus_sync

`default_nettype wire
