// The four channels of a servo IC with the clocks they share. Bit n-1 of a vector, or field n-1 of a packed one,
// belongs to channel n. The bus words are those of all 32 addresses; X:+4 of each channel is left to servo_ic_regs.
// docs/servo_channel.md.
`default_nettype none

module servo_channels (
  input  wire logic        clk_pwm_i,
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  // bus: we_i is high for the one clk_ref edge that writes, rd_i for the one that takes rdata_o as a read's sample
  input  wire logic        sel_i,
  input  wire logic        x_i,
  input  wire logic [4:0]  addr_i,
  input  wire logic        we_i,
  input  wire logic [23:0] wdata_i,
  input  wire logic        rd_i,
  output logic [23:0]      rdata_o,       // 0 when not selected
  // from the registers and the clock chain of the IC
  input  wire logic        trip_i,
  input  wire logic        trip_d_i,
  input  wire logic [11:0] dividers_i,
  input  wire logic [23:0] dac_strobe_i,
  input  wire logic [23:0] adc_strobe_i,
  input  wire logic [7:0]  deadtime_i,
  input  wire logic [16:0] cnt_i,
  input  wire logic        turn_i,
  input  wire logic        phase_rise_i,  // this clk_pwm edge raises, lowers PHASE, lowers SERVO
  input  wire logic        phase_fall_i,
  input  wire logic        servo_fall_i,
  // pins
  input  wire logic [47:0] pins_i,
  input  wire logic [3:0]  adc_a_i,
  input  wire logic [3:0]  adc_b_i,
  output logic [23:0]      pwm_o,
  output logic [3:0]       pulse_o,
  output logic [3:0]       dir_o,
  output logic [3:0]       dac_a_o,
  output logic [3:0]       dac_b_o,
  output logic [3:0]       aena_o,
  output logic [3:0]       equ_o,
  output logic             dac_clk_o,
  output logic             dac_strobe_o,
  output logic             adc_clk_o,
  output logic             adc_strobe_o
);

  logic       sclk_ce, pfm_ce, phase_fall, servo_fall, dac_load, dac_shift, adc_sample;
  logic [4:0] adc_bit;

  channel_clocks u_clocks (
    .clk_pwm_i, .clk_ref_i, .rst_ni,
    .trip_i, .dividers_i, .dac_strobe_i, .adc_strobe_i,
    .phase_rise_i, .phase_fall_i, .servo_fall_i,
    .sclk_ce_o(sclk_ce), .pfm_ce_o(pfm_ce), .phase_fall_o(phase_fall), .servo_fall_o(servo_fall),
    .dac_load_o(dac_load), .dac_shift_o(dac_shift), .adc_sample_o(adc_sample), .adc_bit_o(adc_bit),
    .dac_clk_o, .dac_strobe_o, .adc_clk_o, .adc_strobe_o
  );

  logic [47:0] pins;
  channel_sync u_sync (
    .clk_pwm_i, .rst_ni,
    .pins_i, .pins_o(pins)
  );

  logic [3:0] sel, read_capture;
  always_comb begin
    sel          = {3'd0, sel_i} << addr_i[4:3];
    read_capture = 4'd0;
    if (rd_i && x_i && addr_i[2:0] == brick_regs_pkg::ServoChannelFlagPositionAddr[2:0]) read_capture = sel;
  end

  logic [95:0] rdata;
  logic        count1, down1, still1, fine1;  // of channel 1, which serves the others as a source, too
  logic [23:0] counter1;
  logic [11:0] fraction1;
  for (genvar n = 0; n < 4; n++) begin : gen_channel
    logic        count, down, still, fine;
    logic [23:0] counter;
    logic [11:0] fraction;
    servo_channel u_channel (
      .clk_pwm_i, .clk_ref_i, .rst_ni,
      .x_i, .addr_i(addr_i[2:0]), .sel_i(sel[n]), .we_i(we_i & sel[n]), .wdata_i,
      .read_capture_i(read_capture[n]), .rdata_o(rdata[24*n +: 24]),
      .trip_i, .trip_d_i, .cnt_i, .turn_i, .deadtime_i,
      .sclk_ce_i(sclk_ce), .pfm_ce_i(pfm_ce), .phase_fall_i(phase_fall), .servo_fall_i(servo_fall),
      .dac_load_i(dac_load), .dac_shift_i(dac_shift), .adc_sample_i(adc_sample), .adc_bit_i(adc_bit),
      .count_o(count), .down_o(down), .still_o(still), .fine_o(fine), .counter_o(counter), .fraction_o(fraction),
      .count1_i(count1), .down1_i(down1), .still1_i(still1), .fine1_i(fine1),
      .counter1_i(counter1), .fraction1_i(fraction1),
      .pins_i(pins[12*n +: 12]), .adc_a_i(adc_a_i[n]), .adc_b_i(adc_b_i[n]),
      .pwm_o(pwm_o[6*n +: 6]), .pulse_o(pulse_o[n]), .dir_o(dir_o[n]), .dac_a_o(dac_a_o[n]), .dac_b_o(dac_b_o[n]),
      .aena_o(aena_o[n]), .equ_o(equ_o[n])
    );
    if (n == 0) begin : gen_source
      assign {count1, down1, still1, fine1, counter1, fraction1} = {count, down, still, fine, counter, fraction};
    end else begin : gen_unused
      logic unused;
      assign unused = &{1'b0, count, down, still, fine, counter, fraction};
    end
  end

  assign rdata_o = rdata[23:0] | rdata[47:24] | rdata[71:48] | rdata[95:72];

endmodule : servo_channels

`default_nettype wire
