// Pad of a serial clock: a flip-flop on clk_pwm_i, so that nothing but an edge moves the pin, at the same edges as the
// stream (channel_strobe). It takes the stream's level with each edge of clk_ref, and at 39.3216 MHz rises with the
// clk_pwm edge after that: low for one of the three in a period. Asynchronous reset. servo-ic:5.13/7.
`default_nettype none

module channel_serial_clock (
  input  wire logic clk_pwm_i,
  input  wire logic rst_ni,
  input  wire logic ref_next_i,   // this edge is one of clk_ref
  input  wire logic ref_last_i,   // the one before was
  input  wire logic clk_d_i,      // of channel_strobe
  input  wire logic fast_i,
  output logic      clk_o
);

  logic clk_q;
  always_ff @(posedge clk_pwm_i or negedge rst_ni) begin
    if (!rst_ni)                   clk_q <= 1'b0;
    else if (ref_next_i)           clk_q <= clk_d_i;
    else if (ref_last_i && fast_i) clk_q <= 1'b1;
  end
  assign clk_o = clk_q;

endmodule : channel_serial_clock

`default_nettype wire
