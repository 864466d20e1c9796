// Rules of the PWM outputs at the pins of a channel, servo-ic:5.11, for each of the three phases (`k` is any) and
// anything that triangle, turnarounds, dead time, commands, control word and trip do, at any clock. Two switches of a
// phase that are on at once burn an amplifier. On is the level that X:+5 makes of it: high, inverted low. All of the
// channel but its PWM, with the clock that the triangle takes to it, and the way from there to the pins is free.
// Nothing is assumed but that a run starts in reset.
// proof: induction 2
// clocks: one
// steps: 40
// free: channel_input, channel_index, channel_decode, channel_counter, channel_subcount, channel_capture
// free: channel_compare, channel_pfm, channel_dac, channel_adc, channel_regs
// fault R1: a change of the comparison leaves the switch on that is on (rtl/servo_ic/channel_pwm.sv)
//   - {~raw_q[k], raw_q[k]} & {2{deadtime_i == 8'd0}};
//   + switch_q[2*k+:2] | ({~raw_q[k], raw_q[k]} & {2{deadtime_i == 8'd0}});
// fault R2: the dead time ends a clock early (rtl/servo_ic/channel_pwm.sv)
//   - if (wait_q[12*k+:12] == 12'd1) switch_q
//   + if (wait_q[12*k+:12] == 12'd2) switch_q
// fault R3: the top switch is on where command and triangle are equal (rtl/servo_ic/channel_pwm.sv)
//   - command_b_q > cnt
//   + command_b_q >= cnt
// fault R4: the pair of a PFM output takes part in the inversion (rtl/servo_ic/servo_channel.sv)
//   - if (!c_pfm)  pwm_inv[5:4]
//   + pwm_inv[5:4]
// fault R5: a trip leaves phase A on (rtl/servo_ic/servo_channel.sv)
//   - if (!trip_i) pwm_on = {{2{~c_pfm}}, {4{~ab_dac}}};
//   + pwm_on = {{2{~c_pfm & ~trip_i}}, {4{~ab_dac}}};
`default_nettype none

module channel_pwm_rules (
  input wire logic        clk_i,
  input wire logic        rst_ni,
  input wire logic        trip_i,
  input wire logic [16:0] cnt_i,
  input wire logic        turn_i,
  input wire logic [7:0]  deadtime_i
);

  logic [5:0] pins;
  servo_channel dut (.clk_pwm_i(clk_i), .clk_ref_i(clk_i), .rst_ni, .trip_i, .trip_d_i(1'b0), .cnt_i, .turn_i,
                     .deadtime_i, .pwm_o(pins), .x_i(1'b0), .addr_i(3'd0), .sel_i(1'b0), .we_i(1'b0), .wdata_i(24'h0),
                     .read_capture_i(1'b0), .sclk_ce_i(1'b0), .pfm_ce_i(1'b0), .phase_fall_i(1'b0),
                     .servo_fall_i(1'b0), .dac_load_i(1'b0), .dac_shift_i(1'b0), .adc_sample_i(1'b0),
                     .adc_bit_i(5'd0), .count1_i(1'b0), .down1_i(1'b0), .still1_i(1'b0), .fine1_i(1'b0),
                     .counter1_i(24'd0), .fraction1_i(12'd0), .pins_i(12'd0), .adc_a_i(1'b0), .adc_b_i(1'b0));
  // What the registers, which are free, say.
  (* hierconn *) wire logic [23:0] \dut.control , \dut.out_a , \dut.out_b , \dut.out_c ;
  // From inside, for the inductions.
  (* hierconn *) wire logic [35:0] \dut.u_pwm.wait_q ;
  (* hierconn *) wire logic [16:0] \dut.u_pwm.command_a_q , \dut.u_pwm.command_b_q , \dut.u_pwm.command_c_q ;
  (* hierconn *) wire logic [2:0]  \dut.u_pwm.raw_q , \dut.u_pwm.last_q ;
  (* hierconn *) wire logic [5:0]  \dut.u_pwm.switch_q ;

  (* hierconn *) wire logic [16:0] \dut.u_triangle.cnt_q ;
  (* hierconn *) wire logic        \dut.u_triangle.turn_q ;
  (* hierconn *) wire logic [7:0]  \dut.u_triangle.deadtime_q ;

  // Phase and switch: which are on, bottom and top; the one that is looked at and the other.
  (* anyconst *) logic [1:0] k;
  (* anyconst *) logic       top;
  logic        pwm, inverted, mine, other;
  logic [1:0]  pair, on, inside;
  logic [15:0] written;
  assign pwm      = (k == 2'd2) ? !\dut.control [23] : !\dut.control [22];
  assign inverted = (k == 2'd2) ? \dut.control [21] : \dut.control [20];
  assign pair     = pins[2*k +: 2];
  assign on       = pair ^ {2{inverted}};
  assign mine     = pwm && on[!top];
  assign other    = pwm && on[top];
  assign inside   = \dut.u_pwm.switch_q [2*k +: 2];
  assign written  = (k == 2'd0) ? \dut.out_a [23:8] : (k == 2'd1) ? \dut.out_b [23:8] : \dut.out_c [23:8];

  // What is left of the pause, command in use.
  logic [11:0] left;
  logic [16:0] command;
  assign left    = \dut.u_pwm.wait_q [12*k +: 12];
  assign command = (k == 2'd0) ? \dut.u_pwm.command_a_q :
                   (k == 2'd1) ? \dut.u_pwm.command_b_q : \dut.u_pwm.command_c_q ;

  // Triangle, turnaround and dead time come a clock later to a channel.
  logic [16:0] cnt_q;
  logic        turn_q;
  logic [7:0]  deadtime_q;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) cnt_q <= 17'd0;
    else         cnt_q <= cnt_i;
  end
  always_ff @(posedge clk_i) {turn_q, deadtime_q} <= {turn_i, deadtime_i};

  // The command in use, and what it was against the triangle one and two clocks ago.
  logic signed [15:0] command_q;
  logic               above, above_q, above2_q;
  assign above = 17'(command_q) > $signed(cnt_q);

  // The pause: clocks since the other switch was on, and the shortest dead time set since.
  logic        started_q = 1'b0;
  logic [11:0] dark_q;
  logic [7:0]  shortest_q;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      command_q  <= 16'sd0;
      {above_q, above2_q} <= 2'b00;
      dark_q     <= 12'd0;
      shortest_q <= 8'd15;
    end else begin
      if (turn_q) command_q <= written;
      {above_q, above2_q} <= {above, above_q};
      dark_q  <= other ? 12'd0 : (dark_q == 12'hFFF) ? dark_q : dark_q + 12'd1;
      if (other || deadtime_q < shortest_q) shortest_q <= deadtime_q;
    end
  end

  always @(posedge clk_i) begin
    started_q <= 1'b1;
    // guarantee: power-on
    assume (started_q || !rst_ni);
    // guarantee: choice
    assume (k != 2'd3);
    if (rst_ni) begin
      // R1: Top and bottom switch of a phase are never on together.
      if (pwm) begin
        R1: assert (on != 2'b11);
        C1: cover (on == 2'b01 && inverted);
      end

      // R2: A switch is on only when the other has been off for the dead time, the shortest set meanwhile, or more.
      if (mine) begin
        R2: assert (dark_q >= {shortest_q, 4'd0});
        C2: cover (dark_q == 12'd16 && shortest_q == 8'd1 && top);
      end

      // R3: A top switch is on only if the command was above the triangle three clocks ago, a bottom one if it was not.
      if (pwm && on != 2'b00) begin
        R3: assert (on[0] == above2_q);
        C3: cover (on[0]);
      end

      // R4: A pair that is no PWM output rests low, inverted or not.
      if (!pwm) begin
        R4: assert (pair == 2'b00);
        C4: cover (inverted && k == 2'd2 && inside != 2'b00);
      end

      // R5: A trip turns both switches off.
      if (trip_i && pwm) begin
        R5: assert (on == 2'b00);
        C5: cover (inverted && inside != 2'b00);
      end

      // I1: While something of the pause is left both switches are off; it and what has passed make the dead time.
      I1: assert (left == 12'd0 ? inside == {~above2_q, above2_q} && (!inside[!top] || dark_q >= {shortest_q, 4'd0})
                                : inside == 2'b00 && {1'b0, left} + {1'b0, dark_q} >= {1'b0, shortest_q, 4'd0});

      // I2: Command and comparison inside are those that the pins asked for.
      I2: assert (command == {~command_q[15], command_q} && \dut.u_pwm.raw_q [k] == above_q &&
                  \dut.u_pwm.last_q [k] == above2_q);

      // I3: So are triangle, turnaround and dead time.
      I3: assert ({\dut.u_triangle.cnt_q , \dut.u_triangle.turn_q , \dut.u_triangle.deadtime_q } ==
                  {cnt_q, turn_q, deadtime_q});
    end
  end

endmodule : channel_pwm_rules

`default_nettype wire
