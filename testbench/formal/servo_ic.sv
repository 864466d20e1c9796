// Rules of the outputs after a trip of the watchdog, servo-ic:10/10 and servo-ic:10/11, of a whole servo IC with its
// pins: every register begins with anything, the trip comes when it likes, and the bus does what it likes before and
// after. Off is as servo-ic:5.11/9, servo-ic:5.12/6 and servo-ic:5.13/6 say it, for X:+5 as it stood at the trip. `n`
// is any of the four channels. Encoders, compare, converters, the switches behind the dead time and PHASE are free:
// they do anything. So all of clk_pwm is, and a step is one clk_ref. Assumed: no reset, and a trip that stays
// (`watchdog`, R1).
// proof: pdr
// clocks: one
// steps: 30
// free: channel_input, channel_index, channel_decode, channel_counter, channel_subcount, channel_capture
// free: channel_compare, channel_adc, channel_pwm, channel_serial_clock, channel_sync, clock_gen
// fault R2: bits that say what a pin is can be written (rtl/servo_ic/channel_regs.sv)
//   - control_kept = trip_i ? OutputBits : 24'd0;
//   + control_kept = 24'd0;
// fault R3: a trip does not turn the switches off (rtl/servo_ic/servo_channel.sv)
//   - if (!trip_i) pwm_on
//   + pwm_on
// fault R6: the word of the trip is that of OUT B (rtl/servo_ic/servo_channel.sv)
//   - .command_i(out_b[23:6] & {18{~trip_i}})
//   + .command_i(out_b[23:6])
// fault R7: PHASE starts a word anew after the trip (rtl/servo_ic/channel_clocks.sv)
//   - phase_rise & ~(trip_i & dac_busy)
//   + phase_rise
`default_nettype none

module servo_ic_rules (
  input wire logic        clk_i,
  input wire logic        trip_i,
  input wire logic        trip_d_i,
  input wire logic        sel_i,
  input wire logic        x_i,
  input wire logic [4:0]  addr_i,
  input wire logic        we_i,
  input wire logic        rd_i,
  input wire logic [23:0] wdata_i,
  input wire logic        phase_i,
  input wire logic        servo_i,
  input wire logic [47:0] pins_i,
  input wire logic [3:0]  adc_a_i,
  input wire logic [3:0]  adc_b_i
);

  logic [23:0] rdata;
  logic [3:0]  equ_line;
  logic [motor_pins_pkg::Stride-1:0] motor;
  logic        phase, servo, phase_oe, servo_oe;
  servo_ic dut (.clk_pwm_i(clk_i), .clk_ref_i(clk_i), .rst_ni(1'b1), .sel_i, .x_i, .addr_i, .we_i, .wdata_i,
                .rd_i, .rdata_o(rdata), .phase_i, .servo_i, .phase_o(phase), .servo_o(servo), .phase_oe_o(phase_oe),
                .servo_oe_o(servo_oe), .trip_i, .trip_d_i, .pins_i, .adc_a_i, .adc_b_i, .equ_o(equ_line),
                .motor_o(motor));

  // The pins of a channel, and its control word from inside.
  (* anyconst *) logic [1:0] n;
  logic [5:0] pwm;
  logic       pulse, dir, dac_a, dac_b, aena, equ;
  assign pwm   = motor[motor_pins_pkg::PwmLsb + 6*n +: 6];
  assign pulse = motor[motor_pins_pkg::PulseLsb + n];
  assign dir   = motor[motor_pins_pkg::DirLsb + n];
  assign dac_a = motor[motor_pins_pkg::DacALsb + n];
  assign dac_b = motor[motor_pins_pkg::DacBLsb + n];
  assign aena  = motor[motor_pins_pkg::AenaLsb + n];
  assign equ   = motor[motor_pins_pkg::EquLsb + n];

  // From inside: the words, the DAC stream.
  (* hierconn *) wire logic [23:0] \dut.u_channels.gen_channel[0].u_channel.u_regs.control_q ;
  (* hierconn *) wire logic [23:0] \dut.u_channels.gen_channel[1].u_channel.u_regs.control_q ;
  (* hierconn *) wire logic [23:0] \dut.u_channels.gen_channel[2].u_channel.u_regs.control_q ;
  (* hierconn *) wire logic [23:0] \dut.u_channels.gen_channel[3].u_channel.u_regs.control_q ;
  (* hierconn *) wire logic [16:0] \dut.u_channels.gen_channel[0].u_channel.u_dac_a.word_q ;
  (* hierconn *) wire logic [16:0] \dut.u_channels.gen_channel[0].u_channel.u_dac_b.word_q ;
  (* hierconn *) wire logic [16:0] \dut.u_channels.gen_channel[1].u_channel.u_dac_a.word_q ;
  (* hierconn *) wire logic [16:0] \dut.u_channels.gen_channel[1].u_channel.u_dac_b.word_q ;
  (* hierconn *) wire logic [16:0] \dut.u_channels.gen_channel[2].u_channel.u_dac_a.word_q ;
  (* hierconn *) wire logic [16:0] \dut.u_channels.gen_channel[2].u_channel.u_dac_b.word_q ;
  (* hierconn *) wire logic [16:0] \dut.u_channels.gen_channel[3].u_channel.u_dac_a.word_q ;
  (* hierconn *) wire logic [16:0] \dut.u_channels.gen_channel[3].u_channel.u_dac_b.word_q ;
  (* hierconn *) wire logic [23:0] \dut.u_regs.dac_strobe_q ;
  (* hierconn *) wire logic [23:0] \dut.u_regs.adc_strobe_q ;
  (* hierconn *) wire logic        \dut.u_channels.dac_load ;
  (* hierconn *) wire logic [4:0]  \dut.u_channels.u_clocks.u_dac_stream.left_q ;
  (* hierconn *) wire logic [6:0]  \dut.u_channels.u_clocks.u_dac.left_q ;
  logic [95:0] controls;
  logic [23:0] control;
  logic [33:0] words;  // what the DACs of the channel have still to send behind the bits at their pins, of B and A
  logic [11:0] to_go;  // bits of the DACs' word, edges of clk_ref to the next of them
  assign controls = {\dut.u_channels.gen_channel[3].u_channel.u_regs.control_q ,
                     \dut.u_channels.gen_channel[2].u_channel.u_regs.control_q ,
                     \dut.u_channels.gen_channel[1].u_channel.u_regs.control_q ,
                     \dut.u_channels.gen_channel[0].u_channel.u_regs.control_q };
  assign control  = controls[24*n +: 24];
  always_comb begin
    case (n)
      2'd0: words = {\dut.u_channels.gen_channel[0].u_channel.u_dac_b.word_q ,
                     \dut.u_channels.gen_channel[0].u_channel.u_dac_a.word_q };
      2'd1: words = {\dut.u_channels.gen_channel[1].u_channel.u_dac_b.word_q ,
                     \dut.u_channels.gen_channel[1].u_channel.u_dac_a.word_q };
      2'd2: words = {\dut.u_channels.gen_channel[2].u_channel.u_dac_b.word_q ,
                     \dut.u_channels.gen_channel[2].u_channel.u_dac_a.word_q };
      2'd3: words = {\dut.u_channels.gen_channel[3].u_channel.u_dac_b.word_q ,
                     \dut.u_channels.gen_channel[3].u_channel.u_dac_a.word_q };
    endcase
  end
  assign to_go    = {\dut.u_channels.u_clocks.u_dac_stream.left_q , \dut.u_channels.u_clocks.u_dac.left_q };

  // It comes after the first edge, so that an edge has not seen it before.
  logic started_q = 1'b0, trip_q = 1'b0;
  // guarantee: power-on; watchdog R1
  always_comb assume (started_q ? trip_i || !trip_q : !trip_i);

  // What stood at the trip, and the edges of clk_ref since: none, one, more.
  logic [23:0] kept, kept_q, dac_strobe_kept, dac_strobe_q, adc_strobe_kept, adc_strobe_q;
  logic        dir_kept, dir_q;
  logic [1:0]  edges_q = 2'd0;
  assign kept            = trip_q ? kept_q : control;
  assign dac_strobe_kept = trip_q ? dac_strobe_q : \dut.u_regs.dac_strobe_q ;
  assign adc_strobe_kept = trip_q ? adc_strobe_q : \dut.u_regs.adc_strobe_q ;
  assign dir_kept        = trip_q ? dir_q : dir;
  // The first word of the DACs that began after it: bits so far, the present one included, 25 when it has ended.
  logic [4:0]  bits_q = 5'd0;
  logic [11:0] to_go_q;
  always @(posedge clk_i) begin
    started_q    <= 1'b1;
    trip_q       <= trip_i;
    kept_q       <= kept;
    dac_strobe_q <= dac_strobe_kept;
    adc_strobe_q <= adc_strobe_kept;
    dir_q        <= dir_kept;
    if (trip_i) begin
      if (edges_q != 2'd3) edges_q <= edges_q + 2'd1;
      to_go_q <= to_go;
      if (bits_q == 5'd0) bits_q <= {4'd0, \dut.u_channels.dac_load };
      else if (bits_q != 5'd25 && to_go[6:0] == 7'd0) bits_q <= bits_q + 5'd1;
    end
  end

  logic [5:0] off;
  assign off = {{2{~kept[23] & kept[21]}}, {4{~kept[22] & kept[20]}}};

  always @(posedge clk_i) if (trip_i) begin
    // R1: AENA and EQU are low.
    R1: assert (!aena && !equ && !equ_line[n]);
    C1: cover (control[14]);

    // R2: X:+5 bits 23..19, which say what the pins are and which level is off, stand, as the two strobe words do.
    R2: assert (control[23:19] == kept[23:19] && \dut.u_regs.dac_strobe_q == dac_strobe_kept &&
                \dut.u_regs.adc_strobe_q == adc_strobe_kept);
    C2: cover (control[18:0] != kept[18:0]);

    // R3: All six switches are off, at the level of X:+5 at the trip: low, inverted high; low where there is no PWM.
    R3: assert (pwm == off);
    C3: cover (off == 6'h30 && edges_q == 2'd2);

    // R4: PULSE is off from the first edge of clk_ref on: low, of an inverted PFM high.
    if (edges_q != 2'd0) begin
      R4: assert (pulse == (kept[23] & kept[21]));
      C4: cover (pulse);
    end

    // R5: DIR stands.
    R5: assert (dir == dir_kept);
    C5: cover (dir && edges_q == 2'd2);

    // R6: The data lines of the DACs carry zeros from the first word on that begins after the trip, and no level moves.
    if (bits_q != 5'd0) begin
      R6: assert (dac_a == (kept[22] & kept[20]) && dac_b == (kept[22] & kept[20]) && words == 34'h0);
      C6: cover (dac_a && bits_q == 5'd3);
    end

    // R7: It has ended within 4096 + 3072 edges, 183 us: with each after the one that sees the trip fewer are left.
    if (edges_q >= 2'd2 && bits_q != 5'd25) begin
      R7: assert (to_go < to_go_q || bits_q == 5'd1);
      C7: cover (bits_q == 5'd2);
    end

    // R8: It has its strobe, bit by bit.
    if (bits_q != 5'd0 && bits_q != 5'd25) begin
      R8: assert (motor[motor_pins_pkg::DacStrobeLsb] == dac_strobe_kept[5'd24 - bits_q]);
      C8: cover (bits_q == 5'd3 && motor[motor_pins_pkg::DacStrobeLsb]);
    end

    // R9: Pins that nobody has stay low.
    R9: assert (motor[motor_pins_pkg::Stride-1:motor_pins_pkg::OutBits] == '0);
    C9: cover (aena == 1'b0 && motor[motor_pins_pkg::AdcStrobeLsb]);
  end

endmodule : servo_ic_rules

`default_nettype wire
