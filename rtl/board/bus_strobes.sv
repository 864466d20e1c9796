// Port A strobes as events: each fall of /RD and of /WR turns a flip-flop over, clocked by the strobe itself, so no
// strobe is too short or too close to the next one to be seen. Whoever uses them synchronises the level to a clock of
// his own. Asynchronous reset. docs/port-a.md.
`default_nettype none

module bus_strobes (
  input  wire logic rst_ni,
  input  wire logic pa_rd_ni,
  input  wire logic pa_wr_ni,
  output logic      rd_toggle_o,
  output logic      wr_toggle_o
);

  logic rd_q, wr_q;
  always_ff @(negedge pa_rd_ni or negedge rst_ni) begin
    if (!rst_ni) rd_q <= 1'b0;
    else         rd_q <= ~rd_q;
  end
  always_ff @(negedge pa_wr_ni or negedge rst_ni) begin
    if (!rst_ni) wr_q <= 1'b0;
    else         wr_q <= ~wr_q;
  end

  assign rd_toggle_o = rd_q;
  assign wr_toggle_o = wr_q;

endmodule : bus_strobes

`default_nettype wire
