// Rules of the PWM outputs, servo-ic:5.11, for each of the three phases (`k` is any) and anything that triangle,
// commands, turnarounds and the dead time do, which may change while it runs. Two switches of a phase that are on at
// once burn an amplifier. Nothing is assumed but that a run starts in reset.
// proof: induction 2
// clocks: one
// steps: 40
// fault R1: a change of the comparison leaves the switch on that is on (rtl/servo_ic/channel_pwm.sv)
//   - {~raw_q[k], raw_q[k]} & {2{deadtime_i == 8'd0}};
//   + switch_q[2*k+:2] | ({~raw_q[k], raw_q[k]} & {2{deadtime_i == 8'd0}});
// fault R2: the dead time ends a clock early (rtl/servo_ic/channel_pwm.sv)
//   - if (wait_q[12*k+:12] == 12'd1) switch_q
//   + if (wait_q[12*k+:12] == 12'd2) switch_q
// fault R3: the top switch is on where command and triangle are equal (rtl/servo_ic/channel_pwm.sv)
//   - command_b_q > cnt
//   + command_b_q >= cnt
`default_nettype none

module channel_pwm_rules (
  input wire logic        clk_i,
  input wire logic        rst_ni,
  input wire logic [16:0] cnt_i,
  input wire logic        turn_i,
  input wire logic [7:0]  deadtime_i,
  input wire logic [47:0] command_i
);

  logic [5:0] switches;
  channel_pwm dut (.clk_pwm_i(clk_i), .rst_ni, .cnt_i, .turn_i, .deadtime_i, .command_a_i(command_i[15:0]),
                   .command_b_i(command_i[31:16]), .command_c_i(command_i[47:32]), .switch_o(switches));
  (* hierconn *) wire logic [35:0] \dut.wait_q ;
  (* hierconn *) wire logic [16:0] \dut.command_a_q , \dut.command_b_q , \dut.command_c_q ;
  (* hierconn *) wire logic [2:0]  \dut.raw_q , \dut.last_q ;

  (* anyconst *) logic [1:0] k;
  logic [1:0]  pair;  // bottom, top
  assign pair = switches[2*k +: 2];

  // From inside, for the inductions: what is left of the pause, command in use, comparison.
  logic [11:0] left;
  logic [16:0] command;
  assign left    = \dut.wait_q [12*k +: 12];
  assign command = (k == 2'd0) ? \dut.command_a_q : (k == 2'd1) ? \dut.command_b_q : \dut.command_c_q ;

  // The command in use, and what it was against the triangle one and two clocks ago.
  logic signed [15:0] command_q;
  logic               above, above_q, above2_q;
  assign above = 17'(command_q) > $signed(cnt_i);

  // The pause: clocks since a switch was on, and the shortest dead time set since.
  logic        started_q = 1'b0;
  logic [1:0]  pair_q;
  logic [11:0] dark_q;
  logic [7:0]  shortest_q;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      command_q  <= 16'sd0;
      {above_q, above2_q} <= 2'b00;
      pair_q     <= 2'b00;
      dark_q     <= 12'd0;
      shortest_q <= 8'd15;
    end else begin
      if (turn_i) command_q <= command_i[16*k +: 16];
      {above_q, above2_q} <= {above, above_q};
      pair_q  <= pair;
      dark_q  <= (pair != 2'b00) ? 12'd0 : (dark_q == 12'hFFF) ? dark_q : dark_q + 12'd1;
      if (pair != 2'b00 || deadtime_i < shortest_q) shortest_q <= deadtime_i;
    end
  end

  always @(posedge clk_i) begin
    started_q <= 1'b1;
    assume (started_q || !rst_ni);
    assume (k != 2'd3);
    if (rst_ni) begin
      // R1: Top and bottom switch of a phase are never on together.
      R1: assert (pair != 2'b11);
      C1: cover (switches == 6'b100101);

      // R2: A switch comes on when both have been off for the dead time, the shortest set meanwhile, or more.
      if (pair != 2'b00 && pair != pair_q) begin
        R2: assert (dark_q >= {shortest_q, 4'd0});
        C2: cover (dark_q == 12'd16 && shortest_q == 8'd1 && started_q);
      end

      // R3: A top switch is on only if the command was above the triangle two clocks ago, a bottom one if it was not.
      if (pair != 2'b00) begin
        R3: assert (pair[0] == above2_q);
        C3: cover (pair[0]);
      end

      // I1: While something of the pause is left both switches are off; it and what has passed make the dead time.
      I1: assert (left == 12'd0 ? pair == {~above2_q, above2_q}
                                : pair == 2'b00 && {1'b0, left} + {1'b0, dark_q} >= {1'b0, shortest_q, 4'd0});

      // I2: Command and comparison inside are those that the pins asked for.
      I2: assert (command == {~command_q[15], command_q} && \dut.raw_q [k] == above_q &&
                  \dut.last_q [k] == above2_q);
    end
  end

endmodule : channel_pwm_rules

`default_nettype wire
