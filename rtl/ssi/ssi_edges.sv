// Edges of the PHASE and SERVO nets, for all groups of serial encoder inputs: each output is high before the edge of
// clk_pwm_i that is the first to see the net's new level. No reset: an edge starts nothing before a word is written.
// docs/ssi.md.
`default_nettype none

module ssi_edges (
  input  wire logic clk_pwm_i,
  input  wire logic phase_i,
  input  wire logic servo_i,
  output logic      phase_rise_o,
  output logic      phase_fall_o,
  output logic      servo_rise_o,
  output logic      servo_fall_o
);

  logic phase_q, servo_q;
  always_ff @(posedge clk_pwm_i) begin
    phase_q <= phase_i;
    servo_q <= servo_i;
  end
  assign phase_rise_o = phase_i & ~phase_q;
  assign phase_fall_o = phase_q & ~phase_i;
  assign servo_rise_o = servo_i & ~servo_q;
  assign servo_fall_o = servo_q & ~servo_i;

endmodule : ssi_edges

`default_nettype wire
