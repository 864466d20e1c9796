// Rules of the clock chain, servo-ic:5.1, for any dividers, directions and clock pins, which may change at any clock:
// the triangle, PHASE and SERVO, pins that change their direction, and the alignment to a PHASE from outside. They are
// told by a second description that counts up from what has been, where the design looks a tick ahead. Nothing is
// assumed but that a run starts in reset.
// edit: I7m00 is 2 after a reset, not 6527, so that a few steps reach all of it (rtl/regs/brick_regs_pkg.sv)
//   - ServoIcPwmControlReset = 24'h197F0F;
//   + ServoIcPwmControlReset = 24'h00020F;
// proof: induction 2
// clocks: one
// steps: 40
// fault R2: the triangle stands at its end for two ticks (rtl/servo_ic/clock_gen.sv)
//   - at_top_d    = ramp_q == {2'b00, max_q};
//   + at_top_d    = ramp_q == {2'b00, max_q} + 17'd1;
// fault R4: PHASE falls at the start of its middle way (rtl/servo_ic/clock_gen.sv)
//   - at_middle_d = &ramp_q[16:1] & ~ramp_q[0];
//   + at_middle_d = &ramp_q[16:1];
// fault R7: PHASE does not wait for SERVO (rtl/servo_ic/clock_gen.sv)
//   - & phase_q & (servo_q | ~(servo_oe_q & servo_ext_q));
//   + & phase_q;
// fault R8: a pin is taken while the net is low (rtl/servo_ic/clock_gen.sv)
//   - !phase_q && phase_d && phase_pin)
//   + !phase_q && phase_d)
`default_nettype none

module clock_gen_rules (
  input wire logic        clk_i,
  input wire logic        rst_ni,
  input wire logic [14:0] max_count_i,
  input wire logic [3:0]  phase_div_i,
  input wire logic [3:0]  servo_div_i,
  input wire logic        phase_ext_i,
  input wire logic        servo_ext_i,
  input wire logic        phase_i,
  input wire logic        servo_i
);

  logic               phase, servo, phase_oe, servo_oe, turn, phase_rise, phase_fall, servo_fall;
  logic signed [16:0] cnt;
  clock_gen dut (.clk_pwm_i(clk_i), .rst_ni, .max_count_i, .phase_div_i, .servo_div_i, .phase_ext_i, .servo_ext_i,
                 .phase_i, .servo_i, .phase_o(phase), .servo_o(servo), .phase_oe_o(phase_oe), .servo_oe_o(servo_oe),
                 .cnt_o(cnt), .turn_o(turn), .phase_rise_o(phase_rise), .phase_fall_o(phase_fall),
                 .servo_fall_o(servo_fall));

  // ---------------------------------------------------------------- the second description
  // Settings as taken over: they act from the next edge on.
  logic [14:0] max_count_set_q;
  logic [3:0]  phase_div_set_q, servo_div_set_q;
  logic        phase_ext_set_q, servo_ext_set_q;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      max_count_set_q <= brick_regs_pkg::ServoIcPwmControlReset[22:8];
      {phase_div_set_q, servo_div_set_q} <= {4'd0, 4'd3};
      {phase_ext_set_q, servo_ext_set_q} <= 2'b11;
    end else begin
      max_count_set_q <= max_count_i;
      {phase_div_set_q, servo_div_set_q} <= {phase_div_i, servo_div_i};
      {phase_ext_set_q, servo_ext_set_q} <= {phase_ext_i, servo_ext_i};
    end
  end
  // Triangle: which way, how far along it (0 in the middle), its end I, that of the way's start.
  logic               up_q;
  logic signed [16:0] along_q, end_now;
  logic [14:0]        end_q, start_q;
  assign end_now = $signed({2'b00, end_q});
  // Pins, behind two flip-flops; levels of the clocks; which pins are driven; rises in a row that aligned nothing.
  logic [1:0] phase_pin_q, servo_pin_q, missed_q;
  logic       phase_q, servo_q, phase_oe_q, servo_oe_q;
  // Turnarounds since the phase tick, or since PHASE was an input, and the divider of this period, which began with a
  // tick or not; falls of PHASE since SERVO fell, and the divider of its period.
  logic [3:0] turns_q, phase_div_q, falls_q, servo_div_q;
  logic       ticked_q;
  logic       run_q;    // an edge since the reset
  logic [2:0] taken_q;  // edges since the PHASE pin was taken

  logic       phase_in, servo_in, rise_in, near, moved, turns, phase_tick, half, rises, falls;
  logic       phase_goes, servo_goes, phase_taken, servo_taken, servo_d, phase_d;
  logic [4:0] periods;  // turnarounds of this period of PHASE
  assign phase_in = phase_ext_set_q && !phase_oe_q;
  assign servo_in = servo_ext_set_q && !servo_oe_q;
  assign rise_in  = phase_in && phase_pin_q[1] && !phase_q;
  // The last turnaround, the coming one is 8 ticks away or less.
  assign near     = (along_q < 17'sd0) ? along_q + end_now + 17'sd2 <= 17'sd8 : end_now + 17'sd1 - along_q <= 17'sd8;
  assign moved    = rise_in && (near || missed_q == 2'd3);
  assign turns    = along_q == end_now + 17'sd1 || (moved && along_q >= 17'sd0);

  assign periods    = {1'b0, phase_div_q} + 5'd1;
  assign phase_tick = turns && turns_q == phase_div_q;
  assign half       = ticked_q && (periods[0] ? turns_q >= periods[4:1] && along_q == -17'sd1
                                              : turns && {1'b0, turns_q} + 5'd1 == {1'b0, periods[4:1]});
  // A pin that is to become an input goes while it is high, PHASE with or after SERVO.
  assign servo_goes = servo_oe_q && servo_ext_set_q && servo_q;
  assign phase_goes = phase_oe_q && phase_ext_set_q && phase_q && (servo_q || !(servo_oe_q && servo_ext_set_q));
  always_comb begin
    phase_d = phase_q;
    if (phase_in)        phase_d = phase_pin_q[1];
    else if (phase_tick) phase_d = 1'b1;
    else if (half)       phase_d = 1'b0;
    if (phase_goes)      phase_d = 1'b1;
  end
  assign rises = phase_d && !phase_q;
  assign falls = !phase_d && phase_q;
  always_comb begin
    servo_d = servo_q;
    if (servo_in)                                        servo_d = servo_pin_q[1];
    else if (falls)                                      servo_d = falls_q != servo_div_q;
    else if (rises && servo_div_q == 4'd0)               servo_d = 1'b1;
    else if (rises && falls_q == servo_div_q)            servo_d = 1'b1;
    if (servo_goes)                                      servo_d = 1'b1;
  end
  assign phase_taken = !phase_ext_set_q && rises && phase_pin_q[1];
  assign servo_taken = !servo_ext_set_q && servo_d && !servo_q && servo_pin_q[1];

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      up_q    <= 1'b1;
      along_q <= 17'sd0;
      {end_q, start_q} <= {2{brick_regs_pkg::ServoIcPwmControlReset[22:8]}};
      {phase_pin_q, servo_pin_q, missed_q} <= 6'b111100;
      {phase_q, servo_q, phase_oe_q, servo_oe_q} <= 4'b1100;
      {turns_q, phase_div_q, falls_q, servo_div_q} <= {12'd0, 4'd3};
      ticked_q <= 1'b0;
      taken_q  <= 3'd7;
      run_q    <= 1'b0;
    end else begin
      run_q   <= 1'b1;
      along_q <= along_q + 17'sd1;
      if (turns || moved) begin
        along_q <= -end_now - 17'sd1;
        up_q    <= up_q ^ turns;
        start_q <= end_q;
        if (turns && !up_q) end_q <= max_count_set_q;
      end
      if (rise_in) missed_q <= moved ? 2'd0 : missed_q + 2'd1;
      {phase_pin_q, servo_pin_q} <= {phase_pin_q[0], phase_i, servo_pin_q[0], servo_i};
      if (phase_in) begin
        {turns_q, phase_div_q, ticked_q} <= {4'd0, phase_div_set_q, 1'b0};
      end else if (phase_tick) begin
        {turns_q, phase_div_q, ticked_q} <= {4'd0, phase_div_set_q, 1'b1};
      end else if (turns) begin
        turns_q <= turns_q + 4'd1;
      end
      if (servo_in || (falls && falls_q == servo_div_q)) {falls_q, servo_div_q} <= {4'd0, servo_div_set_q};
      else if (falls)                                    falls_q <= falls_q + 4'd1;
      {phase_q, servo_q} <= {phase_d, servo_d};
      phase_oe_q <= phase_goes ? 1'b0 : phase_oe_q | phase_taken;
      servo_oe_q <= servo_goes ? 1'b0 : servo_oe_q | servo_taken;
      taken_q    <= (!phase_oe_q && phase_taken) ? 3'd0 : taken_q + {2'd0, taken_q != 3'd7};
    end
  end

  // ---------------------------------------------------------------- from inside, for the induction
  (* hierconn *) wire logic [16:0] \dut.ramp_q , \dut.close_from_q , \dut.recent_to_q ;
  (* hierconn *) wire logic [15:0] \dut.larger_q ;
  (* hierconn *) wire logic [14:0] \dut.max_q , \dut.max_count_q ;
  (* hierconn *) wire logic [3:0]  \dut.phase_cnt_q , \dut.fall_cnt_q , \dut.servo_cnt_q ;
  (* hierconn *) wire logic [3:0]  \dut.phase_div_q , \dut.servo_div_q ;
  (* hierconn *) wire logic        \dut.phase_ext_q , \dut.servo_ext_q ;
  (* hierconn *) wire logic [1:0]  \dut.miss_q ;
  (* hierconn *) wire logic        \dut.up_q , \dut.at_top_q , \dut.at_middle_q ;
  (* hierconn *) wire logic        \dut.close_q , \dut.recent_q , \dut.odd_q ;
  (* hierconn *) wire logic        \dut.phase_q , \dut.servo_q , \dut.phase_pin , \dut.servo_pin ;
  (* hierconn *) wire logic        \dut.u_phase_sync.sync1_q , \dut.u_servo_sync.sync1_q ;

  logic started_q = 1'b0;
  always @(posedge clk_i) begin
    started_q <= 1'b1;
    // guarantee: power-on
    assume (started_q || !rst_ni);
    if (rst_ni) begin
      // R1: The triangle stays between -(I7m00 + 2) and I7m00 + 1 of its time.
      R1: assert (cnt <= end_now + 17'sd1 && cnt >= -$signed({2'b00, up_q ? start_q : end_q}) - 17'sd2);
      C1: cover (end_q == 15'd2 && cnt == -17'sd4);

      // R2: It moves one step a tick, turns at its ends, which last a tick, and is moved by a PHASE from outside only:
      // the turnaround that is 8 ticks away or less comes or begins anew, one further away with the fourth such edge in
      // a row.
      R2: assert (cnt == (up_q ? along_q : ~along_q));
      C2: cover (cnt == 17'sd9);

      // R3: Each turnaround, and none else, takes the PWM commands over.
      R3: assert (turn == turns);
      C3: cover (moved && along_q < 17'sd0);

      // R4: PHASE rises at each (I7m01 + 1)-th turnaround and falls half a period later, rounded down; as an input it
      // is its pin behind two flip-flops. A fall that meets the release of the pin is none.
      R4: assert (phase_rise == rises && phase_fall == falls);
      C4: cover (falls && ticked_q && !phase_in && phase_div_q == 4'd1);

      // R5: SERVO falls with each (I7m02 + 1)-th fall of PHASE.
      R5: assert (servo_fall == (servo_q && !servo_d));
      C5: cover (servo_fall && !servo_in && servo_div_q == 4'd1);

      // R6: The pins have these levels, SERVO up again with the next fall of PHASE or, without a divider, its rise;
      // what is an input is high.
      R6: assert (phase == (phase_q || phase_in) && servo == (servo_q || servo_in));
      C6: cover (!servo && servo_oe_q);

      // R7: A pin that is to become an input is driven on until it is high, PHASE until SERVO goes too; then it is
      // high.
      if (phase_oe_q != phase_oe || !phase_oe || !servo_oe) begin
        R7: assert (phase_oe == phase_oe_q && servo_oe == servo_oe_q && (phase_oe || !phase_ext_set_q || phase) &&
                    (servo_oe || !servo_ext_set_q || servo));
        C7: cover (phase_goes && !phase_in);
      end

      // R8: A pin that is to be driven is taken with a rise of the own clock while the net is high, and at no other
      // time.
      if (phase_oe || servo_oe) begin
        R8: assert (phase_oe == phase_oe_q && servo_oe == servo_oe_q);
        C8: cover (phase_oe && servo_taken);
      end

      // R9: From then on PHASE is high for three ticks, a clk_ref, and more, if I7m00 is 2 or more.
      if (taken_q < 3'd3 && start_q >= 15'd2 && phase_oe) begin
        R9: assert (phase);
        C9: cover (taken_q == 3'd2);
      end

      // I6: Both have taken over the same settings.
      I6: assert ({\dut.max_count_q , \dut.phase_div_q , \dut.servo_div_q , \dut.phase_ext_q , \dut.servo_ext_q } ==
                  {max_count_set_q, phase_div_set_q, servo_div_set_q, phase_ext_set_q, servo_ext_set_q});

      // I1: Both descriptions agree about the triangle; flags are true of this tick.
      I1: assert (\dut.ramp_q == along_q && \dut.up_q == up_q && \dut.max_q == end_q && \dut.miss_q == missed_q &&
                  \dut.at_top_q == (along_q == end_now + 17'sd1) && \dut.at_middle_q == (along_q == -17'sd1) &&
                  \dut.close_from_q == end_now - 17'sd8 && \dut.recent_to_q == 17'sd6 - end_now &&
                  \dut.larger_q == {1'b0, end_q} + 16'd8 &&
                  along_q <= end_now + 17'sd1 && along_q >= -$signed({2'b00, start_q}) - 17'sd1);

      // I2: And about the windows, except right after a reset, when PHASE is high and does not rise.
      I2: assert (run_q ? (along_q < 17'sd0 ? \dut.recent_q : \dut.close_q ) == near : phase_q);

      // I3: And about the clocks and their pins.
      I3: assert ({\dut.phase_q , \dut.servo_q , \dut.phase_pin , \dut.servo_pin } ==
                  {phase_q, servo_q, phase_pin_q[1], servo_pin_q[1]} &&
                  phase_oe == phase_oe_q && servo_oe == servo_oe_q &&
                  {\dut.u_phase_sync.sync1_q , \dut.u_servo_sync.sync1_q } == {phase_pin_q[0], servo_pin_q[0]} &&
                  \dut.phase_cnt_q == phase_div_q - turns_q && turns_q <= phase_div_q &&
                  \dut.servo_cnt_q == servo_div_q - falls_q && falls_q <= servo_div_q);

      // I4: And about the fall of PHASE to come.
      I4: assert (\dut.odd_q == (ticked_q && periods[0]) &&
                  \dut.fall_cnt_q == ((ticked_q && turns_q <= periods[4:1]) ? periods[4:1] - turns_q : 4'd0));

      // I5: After a take the way is as old as that, and PHASE is high for its first half.
      if (taken_q < 3'd3 && phase_oe) begin
        I5: assert (along_q == 17'(taken_q) - $signed({2'b00, start_q}) - 17'sd1 && (along_q >= 17'sd0 || phase_q));
      end
    end
  end

endmodule : clock_gen_rules

`default_nettype wire
