// Two-flop synchroniser of the input pins of a servo IC's four channels. Clock clk_pwm_i, asynchronous reset.
`default_nettype none

module channel_sync (
  input  wire logic        clk_pwm_i,
  input  wire logic        rst_ni,
  input  wire logic [47:0] pins_i,
  output logic [47:0]      pins_o
);

  logic [47:0] sync1_q, sync2_q;
  always_ff @(posedge clk_pwm_i or negedge rst_ni) begin
    if (!rst_ni) begin
      sync1_q <= 48'd0;
      sync2_q <= 48'd0;
    end else begin
      sync1_q <= pins_i;
      sync2_q <= sync1_q;
    end
  end
  assign pins_o = sync2_q;

endmodule : channel_sync

`default_nettype wire
