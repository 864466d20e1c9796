// Port A strobes as events: the falls of /RD and of /WR, each counted in two bits that the strobe itself clocks, so
// that it may be high for less than a period of whoever synchronises its level to a clock of his own. Gray code: a
// sample taken while a fall comes is the count before or after it. Every strobe counts, whoever it is for: selects are
// no matter of the edge that clocks, they may be later than it. Asynchronous reset. docs/port_a.md, host-bus:2.6.
`default_nettype none

module bus_strobes (
  input  wire logic  rst_ni,
  input  wire logic  pa_rd_ni,
  input  wire logic  pa_wr_ni,
  output logic [1:0] rd_falls_o,
  output logic [1:0] wr_falls_o
);

  logic [1:0] rd_q, wr_q;
  always_ff @(negedge pa_rd_ni or negedge rst_ni) begin
    if (!rst_ni) rd_q <= 2'd0;
    else         rd_q <= {rd_q[0], ~rd_q[1]};
  end
  always_ff @(negedge pa_wr_ni or negedge rst_ni) begin
    if (!rst_ni) wr_q <= 2'd0;
    else         wr_q <= {wr_q[0], ~wr_q[1]};
  end

  assign rd_falls_o = rd_q;
  assign wr_falls_o = wr_q;

endmodule : bus_strobes

`default_nettype wire
