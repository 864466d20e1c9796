// MACRO IC, clock part: 64 addresses of X and Y words on the bus side, PHASE and SERVO pins on the clock side. The same
// clock chain as in a servo IC (clock_gen), other registers. gate_i tells the kind: 0 DSPGATE2, 1 MACROGATE, which
// drives PHASE at most and never SERVO, so it cannot supply a system. Ring and supplementary channels are not built:
// their words are storage or read 0. Bus on clk_ref_i, clock chain on clk_pwm_i, asynchronous reset. docs/macro_ic.md.
`default_nettype none

module macro_ic (
  input  wire logic        clk_pwm_i,
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        gate_i,
  // bus: we_i is high for the one clk_ref edge that writes; rdata_o follows the address, 0 when not selected
  input  wire logic        sel_i,
  input  wire logic        x_i,
  input  wire logic [5:0]  addr_i,
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

  logic        phase_ext, servo_ext;
  logic [3:0]  phase_div, servo_div;
  logic [14:0] max_count;

  macro_ic_regs u_regs (
    .clk_ref_i, .rst_ni, .gate_i,
    .sel_i, .x_i, .addr_i, .we_i, .wdata_i, .rdata_o,
    .phase_ext_o(phase_ext), .servo_ext_o(servo_ext), .phase_div_o(phase_div), .servo_div_o(servo_div),
    .max_count_o(max_count)
  );

  logic [16:0] cnt;
  logic        turn, phase_rise, phase_fall, servo_fall;

  clock_gen u_clock_gen (
    .clk_pwm_i, .rst_ni,
    .max_count_i(max_count), .phase_div_i(phase_div), .servo_div_i(servo_div),
    .phase_ext_i(phase_ext), .servo_ext_i(servo_ext), .phase_i, .servo_i,
    .phase_o, .servo_o, .phase_oe_o, .servo_oe_o,
    .cnt_o(cnt), .turn_o(turn),
    .phase_rise_o(phase_rise), .phase_fall_o(phase_fall), .servo_fall_o(servo_fall)
  );

  // For the supplementary channels.
  logic unused_channel;
  assign unused_channel = &{1'b0, cnt, turn, phase_rise, phase_fall, servo_fall};

endmodule : macro_ic

`default_nettype wire
