// Time of a proof: clk_pwm rises with every other step, clk_ref with every third of these, of one phase. A step is half
// a period of clk_pwm, 4.24 ns. edge_pwm_o and edge_ref_o say that the edge comes at the end of this step.
`default_nettype none

module proof_clocks (
  output logic       clk_pwm_o,
  output logic       clk_ref_o,
  output logic       edge_pwm_o,
  output logic       edge_ref_o,
  output logic [2:0] step_o       // 0 to 5
);

  logic [2:0] step_q = 3'd0;
  logic       clk_pwm_q = 1'b0, clk_ref_q = 1'b0;
  always @($global_clock) begin
    step_q    <= (step_q == 3'd5) ? 3'd0 : step_q + 3'd1;
    clk_pwm_q <= ~clk_pwm_q;
    clk_ref_q <= step_q < 3'd3;
  end
  assign {clk_pwm_o, clk_ref_o, step_o} = {clk_pwm_q, clk_ref_q, step_q};
  assign edge_pwm_o = !clk_pwm_q;
  assign edge_ref_o = step_q == 3'd0;

endmodule : proof_clocks

`default_nettype wire
