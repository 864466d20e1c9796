// A servo IC as a chip of its own on a board of chips: it hears Port A itself, decodes the whole address and answers
// for the number that its straps say, m for IC m, m + 8 for IC m*; PHASE and SERVO are pins of two ways, as I7m07 has
// them. Clocks are made in this chip, in phase with all others; rst_ref_ni is let go by the board's chip in step with
// clk_ref and passes two flip-flops on clk_pwm here as it does there, so all chips start with the same edge.
// Pads are the vendor's: in, out and enable of those of two ways stand apart here. docs/chips.md.
`default_nettype none

module servo_ic_chip (
  input  wire logic        clk_pwm_i,
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ref_ni,
  input  wire logic [4:0]  number_i,
  // Port A
  input  wire logic [18:0] pa_addr_i,
  input  wire logic        pa_x_i,
  input  wire logic [3:0]  pa_aa_i,
  input  wire logic        pa_int_i,
  input  wire logic        pa_rd_ni,
  input  wire logic        pa_wr_ni,
  input  wire logic [23:0] pa_wdata_i,
  output logic [23:0]      pa_data_o,
  output logic             pa_data_oe_o,
  // clocks, watchdog
  input  wire logic        phase_i,
  input  wire logic        servo_i,
  output logic             phase_o,
  output logic             servo_o,
  output logic             phase_oe_o,
  output logic             servo_oe_o,
  input  wire logic        trip_i,
  // motor side, as of each servo IC in board_top, without what is unused
  input  wire logic [motor_pins_pkg::InBits-1:0] motor_i,
  output logic [motor_pins_pkg::OutBits-1:0]     motor_o
);

  // The level has one clk_pwm from the other chip's flip-flop. So the first one here is not cleared by it: it can stand
  // at the pad, as that of PHASE does, and is in time. The second one acts at once.
  logic rst_taken_q, rst_q, rst_ni;
  always_ff @(posedge clk_pwm_i) rst_taken_q <= rst_ref_ni;
  always_ff @(posedge clk_pwm_i or negedge rst_ref_ni) begin
    if (!rst_ref_ni) rst_q <= 1'b0;
    else             rst_q <= rst_taken_q;
  end
  assign rst_ni = rst_q;

  logic [4:0] number_q;
  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) number_q <= 5'h0;
    else         number_q <= number_i;
  end

  // ------------------------------------------------------------------ Port A, as in board_core
  logic [1:0] rd_falls, wr_falls, bus_rd_falls;
  bus_strobes u_bus_strobes (
    .rst_ni, .pa_rd_ni, .pa_wr_ni,
    .rd_falls_o (rd_falls),
    .wr_falls_o (wr_falls)
  );

  logic [18:0] bus_addr;
  logic [3:0]  bus_aa;
  logic        bus_x, bus_int, bus_we, bus_rd;
  logic [23:0] bus_wdata;
  bus_sync u_bus_sync (
    .clk_pwm_i, .clk_ref_i, .rst_ni,
    .rd_falls_i (rd_falls),
    .wr_falls_i (wr_falls),
    .pa_rd_ni, .pa_wr_ni,
    .pa_addr_i, .pa_x_i, .pa_aa_i, .pa_int_i, .pa_wdata_i,
    .addr_o      (bus_addr),
    .x_o         (bus_x),
    .aa_o        (bus_aa),
    .int_o       (bus_int),
    .wdata_o     (bus_wdata),
    .we_o        (bus_we),
    .rd_o        (bus_rd),
    .rd_falls_o  (bus_rd_falls)
  );

  logic [17:0] number;  // this IC, of those there can be
  logic [21:0] sel_ic;
  logic [7:0]  unused_sel;
  logic        sel;
  assign number = 18'h1 << number_q;
  address_decode u_address_decode (
    .addr_i        (bus_addr),
    .x_i           (bus_x),
    .aa_i          (bus_aa),
    .int_i         (bus_int),
    .fitted_i      ({4'h0, number}),
    .jpan_i        (1'b0),
    .ssi_i         (2'd0),
    .sel_any_o     (unused_sel[0]),
    .sel_int_o     (unused_sel[1]),
    .sel_signals_o (unused_sel[2]),
    .sel_strobe_o  (unused_sel[3]),
    .sel_ctrl_o    (unused_sel[4]),
    .sel_panel_o   (unused_sel[5]),
    .sel_ssi_o     (unused_sel[6]),
    .sel_port_o    (unused_sel[7]),
    .sel_ic_o      (sel_ic)
  );
  assign sel = sel_ic != 22'h0;

  logic [23:0] rdata;
  bus_read u_bus_read (
    .clk_ref_i, .rst_ni, .pa_rd_ni,
    .rd_falls_i (rd_falls),
    .rd_i       (bus_rd),
    .of_i       (bus_rd_falls),
    .sel_any_i  (sel),
    .sel_int_i  (1'b0),
    .data_i     (rdata),
    .data_o     (pa_data_o),
    .oe_o       (pa_data_oe_o)
  );

  // ------------------------------------------------------------------ the IC and its clock pins
  logic        phase, servo, phase_oe, servo_oe;
  logic [3:0]  unused_equ;  // also in motor_o
  logic [motor_pins_pkg::Stride-1:0] motor_out;
  servo_ic u_servo_ic (
    .clk_pwm_i, .clk_ref_i, .rst_ni,
    .sel_i       (sel),
    .x_i         (bus_x),
    .addr_i      (bus_addr[4:0]),
    .we_i        (bus_we),
    .wdata_i     (bus_wdata),
    .rd_i        (bus_rd),
    .rdata_o     (rdata),
    .phase_i, .servo_i,
    .phase_o     (phase),
    .servo_o     (servo),
    .phase_oe_o  (phase_oe),
    .servo_oe_o  (servo_oe),
    .trip_i,
    .trip_d_i    (1'b0),  // the watchdog stands on another chip
    .pins_i      (motor_i[motor_pins_pkg::PinsLsb +: motor_pins_pkg::PinsWidth]),
    .adc_a_i     (motor_i[motor_pins_pkg::AdcALsb +: motor_pins_pkg::AdcAWidth]),
    .adc_b_i     (motor_i[motor_pins_pkg::AdcBLsb +: motor_pins_pkg::AdcBWidth]),
    .equ_o       (unused_equ),
    .motor_o     (motor_out)
  );
  assign motor_o = motor_out[motor_pins_pkg::OutBits-1:0];

  clock_pin u_phase_pin (
    .clk_pwm_i, .clk_ref_i, .rst_ni,
    .level_i(phase), .oe_i(phase_oe), .pad_o(phase_o), .pad_oe_o(phase_oe_o)
  );
  clock_pin u_servo_pin (
    .clk_pwm_i, .clk_ref_i, .rst_ni,
    .level_i(servo), .oe_i(servo_oe), .pad_o(servo_o), .pad_oe_o(servo_oe_o)
  );

  logic unused;
  assign unused = &{1'b0, unused_sel, unused_equ, motor_out[motor_pins_pkg::Stride-1:motor_pins_pkg::OutBits]};

endmodule : servo_ic_chip

`default_nettype wire
