// Port A strobes as events: each fall of /RD and of /WR turns a flip-flop over, clocked by the strobe itself, so that
// the strobe may be high for less than a period of whoever synchronises the level to a clock of his own. With sel_i 0
// the cycle is somebody else's and nothing turns over: selects stand before the strobe falls (rows 101 and 115).
// Asynchronous reset. docs/port_a.md, host-bus:2.6.
`default_nettype none

module bus_strobes (
  input  wire logic rst_ni,
  input  wire logic pa_rd_ni,
  input  wire logic pa_wr_ni,
  input  wire logic sel_i,
  output logic      rd_toggle_o,
  output logic      wr_toggle_o
);

  logic rd_q, wr_q;
  always_ff @(negedge pa_rd_ni or negedge rst_ni) begin
    if (!rst_ni)    rd_q <= 1'b0;
    else if (sel_i) rd_q <= ~rd_q;
  end
  always_ff @(negedge pa_wr_ni or negedge rst_ni) begin
    if (!rst_ni)    wr_q <= 1'b0;
    else if (sel_i) wr_q <= ~wr_q;
  end

  assign rd_toggle_o = rd_q;
  assign wr_toggle_o = wr_q;

endmodule : bus_strobes

`default_nettype wire
