// One PWM output: command against the triangle counter, dead time between the top and the bottom switch. A new command is used
// from the turnaround on. Clock clk_pwm_i, asynchronous reset. docs/servo_channel.md, PWM.
`default_nettype none

module channel_pwm (
  input  wire logic        clk_pwm_i,
  input  wire logic        rst_ni,
  input  wire logic [16:0] cnt_i,       // triangle counter, signed
  input  wire logic        turn_i,      // this edge leaves a turnaround
  input  wire logic [7:0]  deadtime_i,  // in units of 16 clk
  input  wire logic [15:0] command_i,
  output logic             top_o,
  output logic             bot_o
);

  localparam logic [11:0] WaitReset = 12'd240;

  logic [15:0] command_q;
  logic [11:0] wait_q;
  logic        raw, raw_q, top_q, bot_q;
  assign raw = $signed({command_q[15], command_q}) > $signed(cnt_i);

  always_ff @(posedge clk_pwm_i or negedge rst_ni) begin
    if (!rst_ni) begin
      command_q <= 16'd0;
      raw_q     <= 1'b0;
      wait_q    <= WaitReset;
      top_q     <= 1'b0;
      bot_q     <= 1'b0;
    end else begin
      if (turn_i) command_q <= command_i;
      if (raw != raw_q) begin
        raw_q  <= raw;
        wait_q <= {deadtime_i, 4'd0};
        top_q  <= raw & (deadtime_i == 8'd0);
        bot_q  <= ~raw & (deadtime_i == 8'd0);
      end else if (wait_q != 12'd0) begin
        wait_q <= wait_q - 12'd1;
        if (wait_q == 12'd1) begin
          top_q <= raw;
          bot_q <= ~raw;
        end
      end
    end
  end

  assign top_o = top_q;
  assign bot_o = bot_q;

endmodule : channel_pwm

`default_nettype wire
