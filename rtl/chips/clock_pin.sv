// PHASE or SERVO of a chip as a pin of two ways: how clock_gen drives it, to the pad, with the flip-flops that a board
// has in clock_select: the enable counts from a clk_ref edge on, the level passes one flip-flop on clk_pwm, both leave
// through others, two clk later than the IC's own level. So the wire is the net of the board at the same tick.
// Asynchronous reset.
// docs/chips.md.
`default_nettype none

module clock_pin (
  input  wire logic clk_pwm_i,
  input  wire logic clk_ref_i,
  input  wire logic rst_ni,
  input  wire logic level_i,
  input  wire logic oe_i,
  output logic      pad_o,
  output logic      pad_oe_o
);

  logic grant_q, level_q, pad_q, pad_oe_q;
  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) grant_q <= 1'b0;
    else         grant_q <= oe_i;
  end
  always_ff @(posedge clk_pwm_i or negedge rst_ni) begin
    if (!rst_ni) begin
      level_q  <= 1'b1;
      pad_q    <= 1'b1;
      pad_oe_q <= 1'b0;
    end else begin
      level_q  <= level_i;
      pad_q    <= level_q | ~grant_q;
      pad_oe_q <= grant_q;
    end
  end
  assign pad_o    = pad_q;
  assign pad_oe_o = pad_oe_q;

endmodule : clock_pin

`default_nettype wire
