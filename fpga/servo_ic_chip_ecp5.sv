// A servo IC in a Lattice ECP5 of its own (LFE5U-25F-8BG256C): servo_ic_chip between real pads, 169 of them. clk_i is
// the oscillator of the whole board, rst_ref_ni comes from the board's chip. PHASE, SERVO and D are pins of two ways.
// docs/chips.md.
`default_nettype none

module servo_ic_chip_ecp5 (
  input  wire logic        clk_i,
  input  wire logic        rst_ref_ni,
  input  wire logic [4:0]  number_i,
  input  wire logic [18:0] pa_addr_i,
  input  wire logic        pa_x_i,
  input  wire logic [3:0]  pa_aa_i,
  input  wire logic        pa_int_i,
  input  wire logic        pa_rd_ni,
  input  wire logic        pa_wr_ni,
  inout  wire  [23:0]      pa_data_io,
  inout  wire              phase_io,
  inout  wire              servo_io,
  input  wire logic        trip_i,
  input  wire logic [motor_pins_pkg::InBits-1:0] motor_i,
  output logic [motor_pins_pkg::OutBits-1:0]     motor_o
);

  logic clk_pwm, clk_ref, locked;
  ecp5_clocks u_clocks (.clk_i, .clk_pwm_o(clk_pwm), .clk_ref_o(clk_ref), .locked_o(locked));

  logic [23:0] pa_wdata, pa_data;
  logic        pa_oe, phase, phase_q, phase_oe, servo, servo_q, servo_oe;
  ecp5_data_pads u_data (.pad_io(pa_data_io), .d_i(pa_data), .oe_i(pa_oe), .rd_ni(pa_rd_ni), .q_o(pa_wdata));
  ecp5_pads               u_phase   (.pad_io(phase_io), .d_i(phase_q), .oe_i(phase_oe), .q_o(phase));
  ecp5_pads               u_servo   (.pad_io(servo_io), .d_i(servo_q), .oe_i(servo_oe), .q_o(servo));

  servo_ic_chip u_chip (
    .clk_pwm_i    (clk_pwm),
    .clk_ref_i    (clk_ref),
    .rst_ref_ni   (rst_ref_ni & locked),
    .number_i, .pa_addr_i, .pa_x_i, .pa_aa_i, .pa_int_i, .pa_rd_ni, .pa_wr_ni,
    .pa_wdata_i   (pa_wdata),
    .pa_data_o    (pa_data),
    .pa_data_oe_o (pa_oe),
    .phase_i      (phase),
    .servo_i      (servo),
    .phase_o      (phase_q),
    .servo_o      (servo_q),
    .phase_oe_o   (phase_oe),
    .servo_oe_o   (servo_oe),
    .trip_i, .motor_i, .motor_o
  );

endmodule : servo_ic_chip_ecp5

`default_nettype wire
