// Position counter of a channel, 24 bits, with the latches of the phase and servo clocks, and the 1/T timers: T1 is the
// time between the last two counts, T2 the time since the last one, in SCLK periods. Clock clk_ref_i, asynchronous
// reset.
`default_nettype none

module channel_counter (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        ce_i,          // SCLK
  input  wire logic        hold_i,        // counter reset
  input  wire logic        count_i,       // this and the next three at SCLK only
  input  wire logic        down_i,
  input  wire logic        mark_i,        // MLDT: clears T2; copies T2 to T1
  input  wire logic        echo_i,
  input  wire logic        phase_fall_i,
  input  wire logic        servo_fall_i,
  output logic [23:0]      counter_o,
  output logic [23:0]      counter_d_o,   // after this edge
  output logic             down_o,        // direction of the last count
  output logic [22:0]      t1_o,
  output logic [23:0]      phase_pos_o,   // X:+1
  output logic [23:0]      servo_pos_o,   // X:+2
  output logic [23:0]      servo_t1_o,    // Y:+0
  output logic [22:0]      servo_t2_o     // Y:+1
);

  localparam logic [22:0] TimerMax = 23'h7FFFFF;

  logic [23:0] counter_d, counter_q, t1_q, phase_pos_q, servo_pos_q, servo_t1_q;
  logic [22:0] t2_next, t2_q, servo_t2_q;
  logic        down_q;

  assign counter_d = hold_i ? 24'd0 : (!count_i ? counter_q : (down_i ? counter_q - 24'd1 : counter_q + 24'd1));
  assign t2_next   = t2_q == TimerMax ? TimerMax : t2_q + 23'd1;

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      counter_q <= 24'd0;
      t1_q      <= 24'd0;
      t2_q      <= 23'd0;
      down_q    <= 1'b0;
    end else begin
      counter_q <= counter_d;
      if (ce_i) t2_q <= mark_i || count_i ? 23'd0 : t2_next;
      if (echo_i || count_i) begin
        t1_q[brick_regs_pkg::ServoChannelTimer1T1Lsb +: 23]   <= echo_i ? t2_q : t2_next;
        t1_q[brick_regs_pkg::ServoChannelTimer1ReversedLsb]   <= ~echo_i & (down_i ^ down_q);
      end
      if (count_i) down_q <= down_i;
    end
  end

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      phase_pos_q <= 24'd0;
      servo_pos_q <= 24'd0;
      servo_t1_q  <= 24'd0;
      servo_t2_q  <= 23'd0;
    end else begin
      if (phase_fall_i) phase_pos_q <= counter_q;
      if (servo_fall_i) begin
        servo_pos_q[brick_regs_pkg::ServoChannelServoPositionPositionLsb +: 23] <= counter_q[22:0];
        servo_pos_q[brick_regs_pkg::ServoChannelServoPositionDownLsb]           <= down_q;
        servo_t1_q  <= t1_q;
        servo_t2_q  <= t2_q;
      end
    end
  end

  assign counter_o   = counter_q;
  assign counter_d_o = counter_d;
  assign down_o      = down_q;
  assign t1_o        = t1_q[brick_regs_pkg::ServoChannelTimer1T1Lsb +: 23];
  assign phase_pos_o = phase_pos_q;
  assign servo_pos_o = servo_pos_q;
  assign servo_t1_o  = servo_t1_q;
  assign servo_t2_o  = servo_t2_q;

endmodule : channel_counter

`default_nettype wire
