// Reset of the board: asserted with the pin, at once and without a clock; released through two flip-flops on clk_ref_i
// and two on clk_pwm_i. So it ends two clk_pwm_i edges after an edge of clk_ref_i, and the next edge, one of both
// clocks, is the first that works: both domains start with the same one. docs/architecture.md, Reset and power.
`default_nettype none

module reset_sync (
  input  wire logic clk_pwm_i,
  input  wire logic clk_ref_i,
  input  wire logic rst_pin_ni,
  output logic      rst_ref_no,  // released with clk_ref_i: for another chip, which has a second half of its own
  output logic      rst_no
);

  sync2 u_ref (.clk_i(clk_ref_i), .rst_ni(rst_pin_ni), .d_i(1'b1),       .q_o(rst_ref_no));
  sync2 u_pwm (.clk_i(clk_pwm_i), .rst_ni(rst_pin_ni), .d_i(rst_ref_no), .q_o(rst_no));

endmodule : reset_sync

`default_nettype wire
