// Test top: the four channels with the registers and the clock chain of their IC, pins and bus words in the open.
`default_nettype none

module channels_bench (
  input  wire logic        clk_pwm_i,
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        x_i,
  input  wire logic [4:0]  addr_i,
  input  wire logic        we_i,
  input  wire logic [23:0] wdata_i,
  input  wire logic        read_done_i,
  output logic [23:0]      rdata_o,
  input  wire logic        trip_i,
  input  wire logic        phase_i,
  input  wire logic        servo_i,
  input  wire logic [47:0] pins_i,
  input  wire logic [3:0]  adc_a_i,
  input  wire logic [3:0]  adc_b_i,
  output logic [23:0]      pwm_o,
  output logic [23:0]      pins_o,    // EQU, AENA, DAC B, DAC A, DIR, PULSE, four bits each from bit 23 down
  output logic [3:0]       serial_o,  // ADC strobe, ADC clock, DAC strobe, DAC clock
  output logic             phase_o,
  output logic             servo_o
);

  logic [23:0] ic_rdata, channel_rdata;
  logic [11:0] dividers;
  logic        phase_ext, servo_ext;
  logic [3:0]  phase_div, servo_div;
  logic [23:0] dac_strobe, adc_strobe;
  logic [7:0]  deadtime;
  logic [14:0] max_count;
  servo_ic_regs u_regs (
    .clk_ref_i, .rst_ni, .sel_i(1'b1), .x_i, .addr_i, .we_i, .wdata_i, .rdata_o(ic_rdata),
    .clock_dividers_o(dividers), .phase_ext_o(phase_ext), .servo_ext_o(servo_ext), .phase_div_o(phase_div),
    .servo_div_o(servo_div), .dac_strobe_o(dac_strobe), .adc_strobe_o(adc_strobe), .deadtime_o(deadtime), .max_count_o(max_count)
  );

  logic [16:0] cnt;
  logic        turn, phase_rise, phase_fall, servo_fall;
  logic phase_oe, servo_oe, unused_oe;
  assign unused_oe = &{1'b0, phase_oe, servo_oe};

  clock_gen u_clock_gen (
    .clk_pwm_i, .rst_ni, .max_count_i(max_count), .phase_div_i(phase_div), .servo_div_i(servo_div), .phase_ext_i(phase_ext),
    .servo_ext_i(servo_ext), .phase_i, .servo_i, .phase_o, .servo_o, .phase_oe_o(phase_oe), .servo_oe_o(servo_oe), .cnt_o(cnt), .turn_o(turn),
    .phase_rise_o(phase_rise), .phase_fall_o(phase_fall), .servo_fall_o(servo_fall)
  );

  servo_channels u_channels (
    .clk_pwm_i, .clk_ref_i, .rst_ni, .sel_i(1'b1), .x_i, .addr_i, .we_i, .wdata_i,
    .read_done_i, .read_x_i(x_i), .read_addr_i(addr_i), .rdata_o(channel_rdata), .trip_i, .dividers_i(dividers),
    .dac_strobe_i(dac_strobe), .adc_strobe_i(adc_strobe), .deadtime_i(deadtime), .cnt_i(cnt), .turn_i(turn),
    .phase_rise_i(phase_rise), .phase_fall_i(phase_fall), .servo_fall_i(servo_fall), .pins_i, .adc_a_i, .adc_b_i, .pwm_o,
    .pulse_o(pins_o[3:0]), .dir_o(pins_o[7:4]), .dac_a_o(pins_o[11:8]), .dac_b_o(pins_o[15:12]), .aena_o(pins_o[19:16]),
    .equ_o(pins_o[23:20]), .dac_clk_o(serial_o[0]), .dac_strobe_o(serial_o[1]), .adc_clk_o(serial_o[2]),
    .adc_strobe_o(serial_o[3])
  );
  assign rdata_o = ic_rdata | channel_rdata;

endmodule : channels_bench

`default_nettype wire
