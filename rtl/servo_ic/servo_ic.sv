// Servo IC (DSPGATE1): 32 addresses of X and Y words on the bus side, PHASE and SERVO pins on the clock side. Built so far:
// the global registers and the clock chain; words of the four channels read 0 and ignore writes. Bus on clk_ref_i, clock
// chain on clk_pwm_i, asynchronous reset. docs/servo_ic.md.
`default_nettype none

module servo_ic (
  input  wire logic        clk_pwm_i,
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  // bus: we_i is high for the one clk_ref edge that writes; rdata_o follows the address, 0 when not selected
  input  wire logic        sel_i,
  input  wire logic        x_i,
  input  wire logic [4:0]  addr_i,
  input  wire logic        we_i,
  input  wire logic [23:0] wdata_i,
  output logic [23:0]      rdata_o,
  // clock pins
  input  wire logic        phase_i,
  input  wire logic        servo_i,
  output logic             phase_o,
  output logic             servo_o,
  output logic             phase_oe_o,
  output logic             servo_oe_o
);

  logic [11:0] clock_dividers;
  logic        phase_ext, servo_ext;
  logic [3:0]  phase_div, servo_div;
  logic [23:0] dac_strobe, adc_strobe;
  logic [7:0]  deadtime;
  logic [14:0] max_count;

  servo_ic_regs u_regs (
    .clk_ref_i, .rst_ni,
    .sel_i, .x_i, .addr_i, .we_i, .wdata_i, .rdata_o,
    .clock_dividers_o(clock_dividers), .phase_ext_o(phase_ext), .servo_ext_o(servo_ext),
    .phase_div_o(phase_div), .servo_div_o(servo_div), .dac_strobe_o(dac_strobe), .adc_strobe_o(adc_strobe),
    .deadtime_o(deadtime), .max_count_o(max_count)
  );

  logic [16:0] cnt;
  logic        turn, phase_rise, phase_fall, servo_fall;

  clock_gen u_clock_gen (
    .clk_pwm_i, .rst_ni,
    .max_count_i(max_count), .phase_div_i(phase_div), .servo_div_i(servo_div),
    .phase_ext_i(phase_ext), .servo_ext_i(servo_ext), .phase_i, .servo_i,
    .phase_o, .servo_o, .cnt_o(cnt), .turn_o(turn),
    .phase_rise_o(phase_rise), .phase_fall_o(phase_fall), .servo_fall_o(servo_fall)
  );

  assign phase_oe_o = ~phase_ext;
  assign servo_oe_o = ~servo_ext;

  // For the channels.
  logic unused_channel;
  assign unused_channel = &{1'b0, clock_dividers, dac_strobe, adc_strobe, deadtime, cnt, turn, phase_rise, phase_fall, servo_fall};

endmodule : servo_ic

`default_nettype wire
