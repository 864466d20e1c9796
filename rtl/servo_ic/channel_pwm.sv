// The PWM outputs of a channel, phases A, B, C: command against the triangle counter, dead time between the top and the
// bottom switch. A new command is used from the turnaround on. The comparison is registered, so that the switches move
// a clk later than it. Clock clk_pwm_i, asynchronous reset.
// docs/servo_channel.md, PWM.
`default_nettype none

module channel_pwm (
  input  wire logic        clk_pwm_i,
  input  wire logic        rst_ni,
  input  wire logic [16:0] cnt_i,       // triangle counter, signed
  input  wire logic        turn_i,      // this edge leaves a turnaround
  input  wire logic [7:0]  deadtime_i,  // in units of 16 clk
  input  wire logic [15:0] command_a_i,
  input  wire logic [15:0] command_b_i,
  input  wire logic [15:0] command_c_i,
  output logic [5:0]       switch_o     // C bottom, C top, B bottom, B top, A bottom, A top from bit 5 down
);

  localparam int DeadtimeShift = 4;  // the unit is 2^4 clk
  localparam logic [7:0] DeadtimeReset =
      brick_regs_pkg::ServoIcPwmControlReset[brick_regs_pkg::ServoIcPwmControlDeadtimeLsb +: 8];
  localparam logic [11:0] WaitReset = {4'd0, DeadtimeReset} << DeadtimeShift;

  // Counter and commands are compared with their sign bit turned over, as numbers without a sign.
  logic [16:0] cnt, command_a_q, command_b_q, command_c_q;
  logic [35:0] wait_q;
  logic [5:0]  switch_q;
  logic [2:0]  raw_q, last_q;  // comparison, and what the switches follow
  assign cnt = {~cnt_i[16], cnt_i[15:0]};

  always_ff @(posedge clk_pwm_i or negedge rst_ni) begin
    if (!rst_ni) begin
      command_a_q <= 17'h10000;
      command_b_q <= 17'h10000;
      command_c_q <= 17'h10000;
      raw_q       <= 3'd0;
      last_q      <= 3'd0;
      wait_q      <= {3{WaitReset}};
      switch_q    <= 6'd0;
    end else begin
      if (turn_i) begin
        command_a_q <= {~command_a_i[15], command_a_i};
        command_b_q <= {~command_b_i[15], command_b_i};
        command_c_q <= {~command_c_i[15], command_c_i};
      end
      raw_q <= {command_c_q > cnt, command_b_q > cnt, command_a_q > cnt};
      last_q <= raw_q;
      if (raw_q != last_q || wait_q != 36'd0) begin  // rarely: docs/simulation-speed.md
        for (int unsigned k = 0; k < 3; k++) begin
          if (raw_q[k] != last_q[k]) begin
            wait_q[12*k+:12]  <= {4'd0, deadtime_i} << DeadtimeShift;
            switch_q[2*k+:2]  <= {~raw_q[k], raw_q[k]} & {2{deadtime_i == 8'd0}};
          end else if (wait_q[12*k+:12] != 12'd0) begin
            wait_q[12*k+:12] <= wait_q[12*k+:12] - 12'd1;
            if (wait_q[12*k+:12] == 12'd1) switch_q[2*k+:2] <= {~raw_q[k], raw_q[k]};
          end
        end
      end
    end
  end

  assign switch_o = switch_q;

endmodule : channel_pwm

`default_nettype wire
