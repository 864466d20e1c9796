// Hardware clock of a servo IC: clk_ref / 2^n as a one-cycle enable. Free running; a new n is taken at the terminal
// count, so no period is ever cut. Clock clk_ref_i, asynchronous reset: the first edge behind it starts a period.
// docs/servo_channel.md, Clocks.
`default_nettype none

module channel_divider (
  input  wire logic       clk_ref_i,
  input  wire logic       rst_ni,
  input  wire logic [2:0] n_i,
  output logic            ce_o,    // this clk_ref edge starts a period
  output logic            mid_o,   // this edge is half way through the period; never with n = 0
  output logic            fast_o   // the present period is one clk_ref long
);

  logic [6:0] left_q, half_q;  // edges to the next period; half of the present period

  assign ce_o   = left_q == 7'd0;
  assign fast_o = half_q == 7'd0;
  assign mid_o  = ~fast_o & (left_q == half_q);

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni)   left_q <= 7'd0;
    else if (ce_o) left_q <= 7'd127 >> (3'd7 - n_i);
    else           left_q <= left_q - 7'd1;
  end

  always_ff @(posedge clk_ref_i) begin
    if (ce_o) half_q <= 7'd64 >> (3'd7 - n_i);
  end

endmodule : channel_divider

`default_nettype wire
