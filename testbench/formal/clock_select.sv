// Rules of the PHASE and SERVO nets, servo-ic:7.2/5 to servo-ic:7.2/7 and servo-ic:7.3/1, for any IC (`n`) and whatever
// ICs, jumper and pins do: at most one driver, the right one, its level, and conflicts. A step is half a period of
// clk_pwm; every input may change at any. Nothing is assumed but that a run has one reset, at its start. R9 and R10 are
// about ICs that take turns, one at a time and high from a change of direction to the next edge of clk_ref, as rules R7
// to R9 of `clock_gen` have it.
// proof: induction 5
// clocks: several
// steps: 24
// fault R1: each IC that drives is let onto the net (rtl/board/clock_select.sv)
//   - phase_grant_d = ext ? 22'h0 : p & -p;
//   + phase_grant_d = ext ? 22'h0 : p;
// fault R4: an IC that is not fitted can be the source (rtl/board/clock_select.sv)
//   - phase_oe_i & fitted_i};
//   + phase_oe_i};
// fault R8: the conflict of SERVO is overlooked (rtl/board/clock_select.sv)
//   - (|phase_low & |phase_high) | (|servo_low & |servo_high)
//   + (|phase_low & |phase_high)
// fault R9: a net without a driver keeps its last level for one clk_ref (rtl/board/clock_select.sv)
//   - phase_idle_q  <= phase_idle_d;
//   + phase_idle_q  <= phase_idle_d & (drivers_q == drivers_d);
// fault R11: SERVO is told to be driven when it is not (rtl/board/clock_select.sv)
//   - servo_oe_q <= ~servo_idle_q;
//   + servo_oe_q <= servo_idle_q;
`default_nettype none

module clock_select_rules (
  input wire logic        rst_ni,
  input wire logic [21:0] fitted_i,
  input wire logic [21:0] phase_i,
  input wire logic [21:0] servo_i,
  input wire logic [21:0] phase_oe_i,
  input wire logic [21:0] servo_oe_i,
  input wire logic        ext_clock_i,
  input wire logic        ext_phase_i,
  input wire logic        ext_servo_i
);

  logic [2:0] step;
  logic       clk_pwm, clk_ref, edge_ref, started_q = 1'b0;
  proof_clocks clocks (.clk_pwm_o(clk_pwm), .clk_ref_o(clk_ref), .edge_pwm_o(), .edge_ref_o(edge_ref), .step_o(step));
  always @($global_clock) started_q <= 1'b1;
  // guarantee: one reset
  always_comb assume (rst_ni == started_q);

  logic       phase, servo, phase_driven, servo_driven, conflict;
  logic [4:0] source;
  clock_select dut (.clk_pwm_i(clk_pwm), .clk_ref_i(clk_ref), .rst_ni, .fitted_i, .phase_i, .servo_i, .phase_oe_i,
                    .servo_oe_i, .ext_clock_i, .ext_phase_i, .ext_servo_i, .phase_o(phase), .servo_o(servo),
                    .phase_oe_o(phase_driven), .servo_oe_o(servo_driven), .phase_source_o(source),
                    .conflict_o(conflict));
  // From inside: who is let onto each net.
  (* hierconn *) wire logic [21:0] \dut.phase_grant_q ;
  (* hierconn *) wire logic [21:0] \dut.servo_grant_q ;
  (* hierconn *) wire logic        \dut.phase_idle_q ;
  (* hierconn *) wire logic        \dut.servo_idle_q ;
  (* hierconn *) wire logic [44:0] \dut.drivers_q ;
  (* hierconn *) wire logic [43:0] \dut.level_q ;
  (* hierconn *) wire logic        \dut.several_q ;
  (* hierconn *) wire logic [1:0]  \dut.disagree_q ;
  (* hierconn *) wire logic        \dut.conflict_q ;
  (* hierconn *) wire logic        \dut.u_phase_sync.sync1_q ;
  (* hierconn *) wire logic        \dut.u_phase_sync.sync2_q ;
  (* hierconn *) wire logic        \dut.u_servo_sync.sync1_q ;
  (* hierconn *) wire logic        \dut.u_servo_sync.sync2_q ;
  logic [23:0] phase_drivers, servo_drivers;
  assign phase_drivers = {\dut.drivers_q [44], \dut.phase_idle_q , \dut.phase_grant_q };
  assign servo_drivers = {\dut.drivers_q [44], \dut.servo_idle_q , \dut.servo_grant_q };

  // The ICs that drove at the last edge of clk_ref, and for how many steps a level and the right to it have stood.
  (* anyconst *) logic [4:0] n;
  logic        outside_q = 1'b0, level_q, servo_level_q;
  logic [21:0] phase_oe_q = 22'h0, servo_oe_q = 22'h0;
  logic [4:0]  source_q = 5'd0;
  logic [23:0] servo_drivers_q = 24'h0;
  logic [1:0]  stood_q = 2'd0, servo_stood_q = 2'd0;
  logic        level, servo_level, several, stands, servo_stands;
  assign level       = (n < 5'd22) ? phase_i[n] : ext_phase_i;
  assign servo_level = (n < 5'd22) ? servo_i[n] : ext_servo_i;
  assign stands       = source == source_q && level == level_q;
  assign servo_stands = servo_drivers == servo_drivers_q && servo_level == servo_level_q;
  always @($global_clock) begin
    if (edge_ref && rst_ni) begin
      outside_q  <= ext_clock_i;
      phase_oe_q <= phase_oe_i & fitted_i;
      servo_oe_q <= servo_oe_i & fitted_i;
    end
    {source_q, servo_drivers_q, level_q, servo_level_q} <= {source, servo_drivers, level, servo_level};
    stood_q       <= stands ? stood_q + {1'b0, stood_q != 2'd3} : 2'd0;
    servo_stood_q <= servo_stands ? servo_stood_q + {1'b0, servo_stood_q != 2'd3} : 2'd0;
  end

  assign several = outside_q ? (phase_oe_q | servo_oe_q) != 22'h0
                             : |(phase_oe_q & (phase_oe_q - 22'h1)) | (|(servo_oe_q & (servo_oe_q - 22'h1)));

  // Levels of the outside behind two flip-flops; for how many clk drivers of a net have disagreed; their conflict.
  logic       ext_phase1_q = 1'b1, ext_phase2_q = 1'b1, ext_servo1_q = 1'b1, ext_servo2_q = 1'b1;
  logic       phase_differs, servo_differs, conflict_q = 1'b0;
  logic [1:0] differ_q = 2'd0;
  logic [21:0] phase_seen_q = ~22'h0, servo_seen_q = ~22'h0;  // of the ICs, a clk later
  assign phase_differs = (phase_oe_q & ~phase_seen_q) != 22'h0 && (phase_oe_q & phase_seen_q) != 22'h0 ||
                         outside_q && (phase_oe_q & (phase_seen_q ^ {22{ext_phase2_q}})) != 22'h0;
  assign servo_differs = (servo_oe_q & ~servo_seen_q) != 22'h0 && (servo_oe_q & servo_seen_q) != 22'h0 ||
                         outside_q && (servo_oe_q & (servo_seen_q ^ {22{ext_servo2_q}})) != 22'h0;

  // The nets as wires with a pull-up; whether ICs have taken turns so far: no two of them drive, and from a change of
  // direction to the edge of clk_ref that sees it an IC is high. IC 2 has been the source of both once.
  logic        phase_next, servo_next, phase_next_q = 1'b1, servo_next_q = 1'b1;  // what the nets take next
  assign phase_next = \dut.phase_idle_q | (|(\dut.phase_grant_q & \dut.level_q [21:0]));
  assign servo_next = \dut.servo_idle_q | (|(\dut.servo_grant_q & \dut.level_q [43:22]));
  logic        phase_driven_q = 1'b0, servo_driven_q = 1'b0;
  logic        phase_wire_q = 1'b1, servo_wire_q = 1'b1, phase_turns_q = 1'b1, servo_turns_q = 1'b1, passed_q = 1'b0;
  logic [21:0] phase_oe, servo_oe;
  assign phase_oe = phase_oe_i & fitted_i;
  assign servo_oe = servo_oe_i & fitted_i;
  always @($global_clock) begin
    if (!clk_pwm && rst_ni) begin
      {ext_phase2_q, ext_phase1_q} <= {ext_phase1_q, ext_phase_i};
      {ext_servo2_q, ext_servo1_q} <= {ext_servo1_q, ext_servo_i};
      differ_q   <= !(phase_differs || servo_differs) ? 2'd0 : differ_q + {1'b0, !differ_q[1]};
      conflict_q <= several && (conflict_q || ((phase_differs || servo_differs) && differ_q[1]));
      {phase_seen_q, servo_seen_q} <= {phase_i, servo_i};
      phase_wire_q <= &(phase_i | ~phase_oe);
      servo_wire_q <= &(servo_i | ~servo_oe);
      {phase_next_q, servo_next_q} <= {phase_next, servo_next};
      {phase_driven_q, servo_driven_q} <= {outside_q || phase_oe_q != 22'h0, outside_q || servo_oe_q != 22'h0};
    end
    passed_q <= passed_q | (phase_drivers[2] & servo_drivers[2]);
    if (ext_clock_i || outside_q || (phase_oe & (phase_oe - 22'h1)) != 22'h0 ||
        ((phase_oe ^ phase_oe_q) & ~phase_i) != 22'h0) phase_turns_q <= 1'b0;
    if (ext_clock_i || outside_q || (servo_oe & (servo_oe - 22'h1)) != 22'h0 ||
        ((servo_oe ^ servo_oe_q) & ~servo_i) != 22'h0) servo_turns_q <= 1'b0;
  end

  always @($global_clock) if (rst_ni) begin
    // I1: The clocks are as the steps count.
    I1: assert (step <= 3'd5 && clk_pwm == step[0] && clk_ref == (step >= 3'd1 && step <= 3'd3));

    // I2: Who is let onto the nets is who drove at the last edge of clk_ref.
    I2: assert (\dut.phase_grant_q == (outside_q ? 22'h0 : phase_oe_q & -phase_oe_q) &&
                \dut.servo_grant_q == (outside_q ? 22'h0 : servo_oe_q & -servo_oe_q) &&
                \dut.phase_idle_q == (!outside_q && phase_oe_q == 22'h0) &&
                \dut.servo_idle_q == (!outside_q && servo_oe_q == 22'h0) &&
                (source == brick_regs_pkg::ClockSourceOutside) == outside_q &&
                (source == brick_regs_pkg::ClockSourceNone) == \dut.phase_idle_q );

    // I3: While ICs take turns one of them at most drove at the last edge of clk_ref.
    I3: assert ((!phase_turns_q || (!outside_q && (phase_oe_q & (phase_oe_q - 22'h1)) == 22'h0)) &&
                (!servo_turns_q || (!outside_q && (servo_oe_q & (servo_oe_q - 22'h1)) == 22'h0)));

    // I4: The levels of the outside are behind two flip-flops.
    I4: assert (\dut.u_phase_sync.sync1_q == ext_phase1_q && \dut.u_phase_sync.sync2_q == ext_phase2_q &&
                \dut.u_servo_sync.sync1_q == ext_servo1_q && \dut.u_servo_sync.sync2_q == ext_servo2_q);

    // R1: PHASE has exactly one driver: an IC, the outside, or the pull-up.
    R1: assert (phase_drivers != 24'h0 && (phase_drivers & (phase_drivers - 24'h1)) == 24'h0);
    C1: cover (\dut.drivers_q [43:0] == 44'h6);

    // R2: SERVO has exactly one driver, which may be another one.
    R2: assert (servo_drivers != 24'h0 && (servo_drivers & (servo_drivers - 24'h1)) == 24'h0);
    C2: cover (servo_drivers[3] && phase_drivers[2]);

    // R3: With jumper E1 at the last edge of clk_ref the source is the outside; with no IC and no jumper there is none.
    if (outside_q || phase_oe_q == 22'h0) begin
      R3: assert (outside_q ? phase_drivers[23] : (phase_drivers[22] && source >= 5'd22));
      C3: cover (outside_q && phase_oe_q != 22'h0);
    end

    // R4: An IC is the source of PHASE only if it is fitted, drives, and no lower one does.
    if (source == n && n < 5'd22) begin
      R4: assert (phase_oe_q[n] && !outside_q && (phase_oe_q & ((22'h1 << n) - 22'h1)) == 22'h0 && phase_drivers[n]);
      C4: cover (n == 5'd3 && phase_oe_q == 22'hF8);
    end

    // R5: PHASE is the level of its source, if both have stood for four steps.
    if (source == n && n < 5'd22 && stands && stood_q == 2'd3) begin
      R5: assert (phase == level);
      C5: cover (!phase && (phase_oe_q & phase_i) != 22'h0);
    end

    // R6: SERVO is the level of its driver, if both have stood for four steps.
    if (n < 5'd22 && servo_drivers[n] && servo_stands && servo_stood_q == 2'd3) begin
      R6: assert (servo == servo_level);
      C6: cover (!servo && (servo_oe_q & servo_i) != 22'h0);
    end

    // R7: With no driver for four steps both nets are high.
    if (phase_drivers[22] && stands && stood_q == 2'd3 && servo_drivers[22] && servo_stands &&
        servo_stood_q == 2'd3) begin
      R7: assert (phase && servo);
      C7: cover (phase_i == 22'h0);
    end

    // R8: A conflict shows from the clk after the third on for which drivers of a net disagree, until each net has one,
    // never else.
    R8: assert (conflict == (several && conflict_q) && \dut.drivers_q == {outside_q, servo_oe_q, phase_oe_q} &&
                \dut.several_q == several && \dut.disagree_q == differ_q && \dut.conflict_q == conflict_q &&
                \dut.level_q == {servo_seen_q, phase_seen_q});
    C8: cover (conflict && !outside_q && (phase_oe_q & (phase_oe_q - 22'h1)) == 22'h0);

    // R9: While ICs take turns PHASE is what a wire would be, two clk later: no level cut nor doubled at the hand-over.
    if (phase_turns_q) begin
      R9: assert (phase_next == phase_wire_q && phase == phase_next_q);
      C9: cover (!phase && \dut.phase_grant_q [3] && passed_q);
    end

    // R10: So is SERVO.
    if (servo_turns_q) begin
      R10: assert (servo_next == servo_wire_q && servo == servo_next_q);
      C10: cover (!servo && \dut.servo_grant_q [3] && passed_q);
    end

    // R11: Whether an IC or the outside drives a net is told with the level.
    R11: assert ({phase_driven, servo_driven} == {phase_driven_q, servo_driven_q});
    C11: cover (phase_driven && !servo_driven);
  end

endmodule : clock_select_rules

`default_nettype wire
