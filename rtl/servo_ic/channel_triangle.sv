// What a channel's PWM needs of the IC, a tick later in flip-flops of the channel's own: the four stand apart on a chip
// and a tick is spent on the way to them. So the PWM is a tick behind the triangle, as the board's nets are. Synthesis
// keeps each channel's: shared they would stand in the middle again. Clock clk_pwm_i, asynchronous reset of the counter
// alone: the first edge behind it takes commands of 0 at most and begins no dead time. docs/fpga.md.
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

  logic [16:0] cnt_q;
  logic        turn_q;
  logic [7:0]  deadtime_q;
  always_ff @(posedge clk_pwm_i or negedge rst_ni) begin
    if (!rst_ni) cnt_q <= 17'd0;
    else         cnt_q <= cnt_i;
  end

  always_ff @(posedge clk_pwm_i) begin
    turn_q     <= turn_i;
    deadtime_q <= deadtime_i;
  end

  assign cnt_o      = cnt_q;
  assign turn_o     = turn_q;
  assign deadtime_o = deadtime_q;

endmodule : channel_triangle

`default_nettype wire
