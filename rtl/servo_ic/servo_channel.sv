// One channel of a servo IC: encoder, flags, capture, compare, three outputs as PWM, DAC or PFM, two ADC inputs. Only
// the PWM runs on clk_pwm_i, everything else on clk_ref_i. Asynchronous reset. docs/servo_channel.md.
`default_nettype none

module servo_channel (
  input  wire logic        clk_pwm_i,
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  // bus
  input  wire logic        x_i,
  input  wire logic [2:0]  addr_i,
  input  wire logic        sel_i,
  input  wire logic        we_i,
  input  wire logic [23:0] wdata_i,
  input  wire logic        read_capture_i,  // this edge takes the sample of a read of X:+3
  output logic [23:0]      rdata_o,         // 0 when not selected
  // from the IC
  input  wire logic        trip_i,          // the watchdog has tripped
  input  wire logic        trip_d_i,        // it trips with the coming edge of clk_ref, or has; 0 where nobody knows
  input  wire logic [16:0] cnt_i,
  input  wire logic        turn_i,
  input  wire logic [7:0]  deadtime_i,      // I7m04
  input  wire logic        sclk_ce_i,
  input  wire logic        pfm_ce_i,
  input  wire logic        phase_fall_i,
  input  wire logic        servo_fall_i,
  input  wire logic        dac_load_i,
  input  wire logic        dac_shift_i,
  input  wire logic        adc_sample_i,
  input  wire logic [4:0]  adc_bit_i,
  // position of this channel for the compare of others, and of channel 1
  output logic             count_o,         // this edge counts
  output logic             down_o,
  output logic             still_o,         // held at 0, or MLDT: no motion
  output logic             fine_o,          // I7mn9
  output logic [23:0]      counter_o,
  output logic [11:0]      fraction_o,
  input  wire logic        count1_i,
  input  wire logic        down1_i,
  input  wire logic        still1_i,
  input  wire logic        fine1_i,
  input  wire logic [23:0] counter1_i,
  input  wire logic [11:0] fraction1_i,
  // pins; inputs behind the synchroniser
  input  wire logic [11:0] pins_i,          // T, U, V, W, USER, MLIM, PLIM, HMFL, FAULT, C, B, A from bit 11 down
  input  wire logic        adc_a_i,
  input  wire logic        adc_b_i,
  output logic [5:0]       pwm_o,           // C bottom, C top, B bottom, B top, A bottom, A top from bit 5 down
  output logic             pulse_o,
  output logic             dir_o,
  output logic             dac_a_o,
  output logic             dac_b_o,
  output logic             aena_o,
  output logic             equ_o
);

  logic [23:0] control, out_a, out_b, out_c;
  // Control word
  logic       index_inv, flag_inv, hold, mldt, other, aena, gated, gate_low, demux, fine;
  logic       dir_inv, ab_inv, c_inv, ab_dac, c_pfm;
  logic [1:0] flag_select, capture_source;
  logic [3:0] mode;
  assign mode           = control[brick_regs_pkg::ServoChannelControlDecodeLsb +: 4];
  assign capture_source = control[brick_regs_pkg::ServoChannelControlCaptureSourceLsb +: 2];
  assign index_inv      = control[brick_regs_pkg::ServoChannelControlIndexInvertLsb];
  assign flag_inv       = control[brick_regs_pkg::ServoChannelControlFlagInvertLsb];
  assign flag_select    = control[brick_regs_pkg::ServoChannelControlFlagSelectLsb +: 2];
  assign hold           = control[brick_regs_pkg::ServoChannelControlCounterResetLsb];
  assign mldt           = mode == brick_regs_pkg::DecodeMldt;
  assign other          = control[brick_regs_pkg::ServoChannelControlCompareChannelLsb];
  assign gated          = control[brick_regs_pkg::ServoChannelControlGatedIndexLsb];
  assign gate_low       = control[brick_regs_pkg::ServoChannelControlGateStateLsb];
  assign demux          = control[brick_regs_pkg::ServoChannelControlIndexDemuxLsb];
  assign fine           = control[brick_regs_pkg::ServoChannelControlHardware1tLsb];
  assign dir_inv        = control[brick_regs_pkg::ServoChannelControlPfmDirInvertLsb];
  assign ab_inv         = control[brick_regs_pkg::ServoChannelControlAbInvertLsb];
  assign c_inv          = control[brick_regs_pkg::ServoChannelControlCInvertLsb];
  assign ab_dac         = control[brick_regs_pkg::ServoChannelControlAbDacLsb];
  assign c_pfm          = control[brick_regs_pkg::ServoChannelControlCPfmLsb];

  // Inputs
  logic [23:12] pin_level, level;  // as in the status word
  logic         ready, index, incomplete, loss;
  channel_input u_input (
    .clk_ref_i, .rst_ni, .ce_i(sclk_ce_i),
    .pins_i, .level_o(pin_level), .ready_o(ready)
  );
  channel_index u_index (
    .clk_ref_i, .rst_ni, .ce_i(sclk_ce_i),
    .ready_i(ready), .level_i(pin_level),
    .gated_i(gated), .gate_low_i(gate_low), .demux_i(demux),
    .level_o(level), .index_o(index), .incomplete_o(incomplete), .loss_o(loss)
  );

  // Position
  logic        count, down, error, mark, echo, last_down, pfm_event, pfm_down;
  logic [23:0] counter, counter_d, phase_pos, servo_pos, servo_t1;
  logic [22:0] t1, servo_t2;
  logic [11:0] fraction, fraction_d, servo_fraction_q;
  channel_decode u_decode (
    .clk_ref_i, .ce_i(sclk_ce_i),
    .ready_i(ready), .mode_i(mode), .hold_i(hold),
    .abc_i(pin_level[brick_regs_pkg::ServoChannelStatusChaLsb +: 3]),
    .pulse_i(pfm_event), .pulse_down_i(pfm_down),
    .count_o(count), .down_o(down), .error_o(error), .mark_o(mark), .echo_o(echo)
  );
  channel_counter u_counter (
    .clk_ref_i, .rst_ni, .ce_i(sclk_ce_i),
    .hold_i(hold), .count_i(count), .down_i(down), .mark_i(mark), .echo_i(echo),
    .phase_fall_i, .servo_fall_i,
    .counter_o(counter), .counter_d_o(counter_d), .down_o(last_down), .t1_o(t1),
    .phase_pos_o(phase_pos), .servo_pos_o(servo_pos), .servo_t1_o(servo_t1), .servo_t2_o(servo_t2)
  );
  channel_subcount u_subcount (
    .clk_ref_i, .ce_i(sclk_ce_i),
    .enable_i(fine & ~still_o), .count_i(count),
    .reversed_i(down ^ last_down), .down_i(last_down), .down_new_i(down), .t1_i(t1),
    .fraction_o(fraction), .fraction_d_o(fraction_d)
  );
  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni)           servo_fraction_q <= 12'd0;
    else if (servo_fall_i) servo_fraction_q <= fraction;
  end
  assign count_o    = count;
  assign down_o     = down;
  assign still_o    = hold | mldt;
  assign fine_o     = fine;
  assign counter_o  = counter;
  assign fraction_o = fine ? fraction : 12'd0;

  // Capture
  logic        captured, captured_gi;
  logic [2:0]  hall;
  logic [23:0] capture_pos;
  logic [11:0] capture_fraction;
  channel_capture u_capture (
    .clk_ref_i, .rst_ni, .ce_i(sclk_ce_i),
    .ready_i(ready), .index_i(index),
    .hmfl_i(level[brick_regs_pkg::ServoChannelStatusHmflLsb]),
    .plim_i(level[brick_regs_pkg::ServoChannelStatusPlimLsb]),
    .mlim_i(level[brick_regs_pkg::ServoChannelStatusMlimLsb]),
    .user_i(level[brick_regs_pkg::ServoChannelStatusUserLsb]),
    .hall_i(level[brick_regs_pkg::ServoChannelStatusFlagWLsb +: 3]),
    .source_i(capture_source), .index_inv_i(index_inv), .flag_inv_i(flag_inv),
    .flag_select_i(flag_select), .gated_i(gated),
    .counter_d_i(counter_d), .fraction_d_i(fraction_d), .read_i(read_capture_i),
    .position_o(capture_pos), .fraction_o(capture_fraction),
    .captured_o(captured), .captured_gi_o(captured_gi), .hall_o(hall)
  );

  // Compare
  logic [23:0] compare_a, compare_b, compare_inc;
  logic [11:0] a_fraction, b_fraction;
  logic [5:0]  compare_we;
  logic        equ;
  channel_compare u_compare (
    .clk_ref_i, .rst_ni, .ce_i(sclk_ce_i),
    .fine_i(fine), .other_i(other), .source_fine_i(other ? fine1_i : fine),
    .count_i(other ? count1_i : count), .down_i(other ? down1_i : down), .still_i(other ? still1_i : still_o),
    .counter_i(other ? counter1_i : counter), .fraction_i(other ? fraction1_i : fraction),
    .we_i(compare_we), .wdata_i, .trip_d_i,
    .a_o(compare_a), .b_o(compare_b), .inc_o(compare_inc),
    .a_fraction_o(a_fraction), .b_fraction_o(b_fraction), .equ_o(equ)
  );
  assign equ_o = equ & ~trip_i;

  // Outputs
  logic [16:0] cnt;
  logic        turn;
  logic [7:0]  deadtime;
  logic [5:0]  pwm, pwm_on, pwm_inv;
  channel_triangle u_triangle (
    .clk_pwm_i, .rst_ni, .cnt_i, .turn_i, .deadtime_i,
    .cnt_o(cnt), .turn_o(turn), .deadtime_o(deadtime)
  );
  channel_pwm u_pwm (
    .clk_pwm_i, .rst_ni, .cnt_i(cnt), .turn_i(turn), .deadtime_i(deadtime),
    .command_a_i(out_a[23:8]), .command_b_i(out_b[23:8]), .command_c_i(out_c[23:8]),
    .switch_o(pwm)
  );
  // A pair that is not a PWM output rests low; a trip turns both switches off, whatever their polarity: the bits that
  // say so keep their value meanwhile.
  always_comb begin
    pwm_on  = 6'd0;
    pwm_inv = 6'd0;
    if (!trip_i) pwm_on = {{2{~c_pfm}}, {4{~ab_dac}}};
    if (!c_pfm)  pwm_inv[5:4] = {2{c_inv}};
    if (!ab_dac) pwm_inv[3:0] = {4{ab_inv}};
  end
  assign pwm_o = (pwm & pwm_on) ^ pwm_inv;

  logic pulse;
  channel_pfm u_pfm (
    .clk_ref_i, .rst_ni, .pfm_ce_i, .sclk_ce_i,
    .run_i(c_pfm & ~trip_i), .command_i(out_c), .width_i(deadtime_i),
    .pulse_o(pulse), .down_o(pfm_down), .event_o(pfm_event)
  );
  assign pulse_o = c_pfm & (pulse ^ c_inv);
  assign dir_o   = c_pfm & (pfm_down ^ dir_inv);

  logic dac_a, dac_b;
  channel_dac u_dac_a (
    .clk_ref_i, .rst_ni,
    .load_i(dac_load_i), .shift_i(dac_shift_i), .command_i(out_a[23:6] & {18{~trip_i}}), .data_o(dac_a)
  );
  channel_dac u_dac_b (
    .clk_ref_i, .rst_ni,
    .load_i(dac_load_i), .shift_i(dac_shift_i), .command_i(out_b[23:6] & {18{~trip_i}}), .data_o(dac_b)
  );
  assign dac_a_o = ab_dac & (dac_a ^ ab_inv);
  assign dac_b_o = ab_dac & (dac_b ^ ab_inv);
  assign aena_o  = aena & ~trip_i;

  // ADC
  logic [17:0] adc_a, adc_b;
  channel_adc u_adc_a (
    .clk_ref_i, .rst_ni,
    .sample_i(adc_sample_i), .bit_i(adc_bit_i), .phase_fall_i, .data_i(adc_a_i), .value_o(adc_a)
  );
  channel_adc u_adc_b (
    .clk_ref_i, .rst_ni,
    .sample_i(adc_sample_i), .bit_i(adc_bit_i), .phase_fall_i, .data_i(adc_b_i), .value_o(adc_b)
  );

  channel_regs u_regs (
    .clk_ref_i, .rst_ni,
    .x_i, .addr_i, .sel_i, .we_i, .wdata_i, .rdata_o, .trip_i, .trip_d_i,
    .control_o(control), .aena_o(aena), .out_a_o(out_a), .out_b_o(out_b), .out_c_o(out_c), .compare_we_o(compare_we),
    .level_i(level), .error_i(error), .loss_i(loss), .equ_i(equ_o), .incomplete_i(incomplete),
    .captured_i(captured), .captured_gi_i(captured_gi), .hall_i(hall),
    .phase_pos_i(phase_pos), .servo_pos_i(servo_pos), .servo_t1_i(servo_t1), .servo_t2_i(servo_t2),
    .servo_fraction_i(servo_fraction_q), .capture_pos_i(capture_pos), .capture_fraction_i(capture_fraction),
    .adc_a_i(adc_a), .adc_b_i(adc_b),
    .compare_a_i(compare_a), .compare_b_i(compare_b), .compare_inc_i(compare_inc),
    .a_fraction_i(a_fraction), .b_fraction_i(b_fraction)
  );

  logic unused;  // bits of AENA, EQU write and state: channel_regs has acted on them
  assign unused = &{1'b0, control[14], control[12:11], out_a[5:0], out_b[5:0]};

endmodule : servo_channel

`default_nettype wire
