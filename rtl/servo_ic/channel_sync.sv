// Two-flop synchroniser of the input pins of a servo IC's four channels. Clock clk_pwm_i, asynchronous reset.
`default_nettype none

module channel_sync (
  input  wire logic        clk_pwm_i,
  input  wire logic        rst_ni,
  input  wire logic [47:0] pins_i,
  output logic [47:0]      pins_o
);

  sync2 #(.Width(48)) u_sync (.clk_i(clk_pwm_i), .rst_ni, .d_i(pins_i), .q_o(pins_o));

endmodule : channel_sync

`default_nettype wire
