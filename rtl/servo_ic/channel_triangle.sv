// What a channel's PWM needs of the IC, a tick later in flip-flops of the channel's own: the four stand apart on a chip
// and a tick is spent on the way to them. So the PWM is a tick behind the triangle, as the board's nets are. Synthesis
// keeps each channel's: shared they would stand in the middle again. Clock clk_pwm_i, asynchronous reset. docs/fpga.md.
`default_nettype none

(* keep_hierarchy = "true" *)
module channel_triangle (
  input  wire logic        clk_pwm_i,
  input  wire logic        rst_ni,
  input  wire logic [16:0] cnt_i,       // triangle counter, signed
  input  wire logic        turn_i,      // this edge leaves a turnaround
  input  wire logic [7:0]  deadtime_i,  // I7m04
  output logic [16:0]      cnt_o,
  output logic             turn_o,
  output logic [7:0]       deadtime_o
);

  localparam logic [7:0] DeadtimeReset =
      brick_regs_pkg::ServoIcPwmControlReset[brick_regs_pkg::ServoIcPwmControlDeadtimeLsb +: 8];

  logic [16:0] cnt_q;
  logic        turn_q;
  logic [7:0]  deadtime_q;
  always_ff @(posedge clk_pwm_i or negedge rst_ni) begin
    if (!rst_ni) begin
      cnt_q      <= 17'd0;
      turn_q     <= 1'b0;
      deadtime_q <= DeadtimeReset;
    end else begin
      cnt_q      <= cnt_i;
      turn_q     <= turn_i;
      deadtime_q <= deadtime_i;
    end
  end

  assign cnt_o      = cnt_q;
  assign turn_o     = turn_q;
  assign deadtime_o = deadtime_q;

endmodule : channel_triangle

`default_nettype wire
